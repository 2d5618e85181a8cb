// SPDX-License-Identifier: Apache-2.0
// KHR_materials_anisotropy: the reference's lobe, energy, tangents, and every renderer against
// float64 rays.
#include <gtest/gtest.h>

#include <numbers>

#include "host/measure/reference/reference_brdf.h"
#include "tests/support/lobe_pictures.h"
#include "tests/support/quad_scene.h"

namespace kilolux {
namespace {

glm::dvec3 towards(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// White metal.
SurfaceSample brushed(double roughness, double strength, double around = 0.3) {
    SurfaceSample s;
    s.kind = SurfaceKind::lit;
    s.albedo = glm::dvec3(1.0);
    s.metallic = 1.0;
    s.roughness = roughness;
    s.anisotropy = strength;
    s.tangent = towards(std::numbers::pi / 2.0, around);
    return s;
}

// The text's alphas and functions of them.
struct Text {
    double ab, at;
    glm::dvec3 t, b;

    explicit Text(const SurfaceSample& s)
        : ab(s.roughness * s.roughness),
          at(ab * (1.0 - s.anisotropy * s.anisotropy) + s.anisotropy * s.anisotropy),
          t(s.tangent),
          b(glm::cross(glm::dvec3(0, 0, 1), s.tangent)) {}

    double d(const glm::dvec3& h) const {
        const double x = std::pow(glm::dot(h, t) / at, 2.0) + std::pow(glm::dot(h, b) / ab, 2.0);
        return 1.0 / (std::numbers::pi * at * ab * std::pow(x + h.z * h.z, 2.0));
    }
    double length(const glm::dvec3& w) const {
        return glm::length(glm::dvec3(at * glm::dot(w, t), ab * glm::dot(w, b), w.z));
    }
    double v(const glm::dvec3& to_eye, const glm::dvec3& l) const {
        return 0.5 / (l.z * length(to_eye) + to_eye.z * length(l));
    }
};

TEST(Anisotropy, TheReferenceIsTheText) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 2000; ++i) {
        const SurfaceSample s =
            brushed(0.05 + 0.95 * unit(random), 0.25 * (i % 5), 6.28 * unit(random));
        const glm::dvec3 v = towards(1.55 * unit(random), 6.28 * unit(random));
        const glm::dvec3 l = towards(1.55 * unit(random), 6.28 * unit(random));
        const Text text(s);
        const double expected = text.d(glm::normalize(v + l)) * text.v(v, l);
        EXPECT_NEAR(reference_brdf(s, v, l, Shading::pbr).x, expected, 1e-9 * expected) << i;
    }
}

TEST(Anisotropy, IsReciprocal) {
    for (int i = 0; i < 200; ++i) {
        const SurfaceSample s = brushed(0.004 * i + 0.1, 0.005 * i);
        const glm::dvec3 a = towards(0.007 * i + 0.1, 0.1 * i), b = towards(1.4 - 0.005 * i, 2);
        const double there = reference_brdf(s, a, b, Shading::pbr).x;
        EXPECT_NEAR(reference_brdf(s, b, a, Shading::pbr).x, there, 1e-12 * there) << i;
    }
}

// The integral over the half vectors of a lobe of what `value` gives, with their cosine.
template <typename Value>
double integral(const Text& text, const Value& value) {
    constexpr int kRings = 400, kColumns = 800;
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < kColumns; ++j) {
            // Slopes of the microsurface, in widths of the lobe.
            const double u = (i + 0.5) / kRings,
                         phi = 2.0 * std::numbers::pi * (j + 0.5) / kColumns;
            const double slope = u / (1.0 - u);
            const glm::dvec3 h =
                glm::normalize(text.t * (slope * text.at * std::cos(phi)) +
                               text.b * (slope * text.ab * std::sin(phi)) + glm::dvec3(0, 0, 1));
            const double slopes = text.at * text.ab * slope / ((1.0 - u) * (1.0 - u)) *
                                  (2.0 * std::numbers::pi / kColumns / kRings);
            sum += value(h) * h.z * h.z * h.z * h.z * slopes;  // a solid angle is h.z^3 slopes
        }
    }
    return sum;
}

// A microsurface covers its plane once. D is found where the eye looks along the light.
TEST(Anisotropy, DistributionsCoverThePlaneOnce) {
    for (const double roughness : {0.05, 0.3, 1.0}) {
        for (const double strength : {0.0, 0.5, 1.0}) {
            const SurfaceSample s = brushed(roughness, strength);
            const Text text(s);
            const double covered = integral(text, [&](const glm::dvec3& h) {
                return reference_brdf(s, h, h, Shading::pbr).x / text.v(h, h);
            });
            EXPECT_NEAR(covered, 1.0, 1e-3) << roughness << ' ' << strength;
        }
    }
}

// White furnace: the lobe loses what would be scattered again, and never gains.
TEST(Anisotropy, ReturnsNoMoreThanArrives) {
    for (const double roughness : {0.05, 0.3, 1.0}) {
        for (const double strength : {0.0, 0.5, 1.0}) {
            for (const double theta : {0.0, 0.8, 1.5}) {
                const SurfaceSample s = brushed(roughness, strength);
                const glm::dvec3 v = towards(theta, 1.0);
                const double furnace = integral(Text(s), [&](const glm::dvec3& h) {
                    const double v_dot_h = glm::dot(v, h);
                    const glm::dvec3 l = 2.0 * v_dot_h * h - v;
                    if (l.z <= 0.0 || v_dot_h <= 0.0) return 0.0;
                    return 4.0 * v_dot_h / h.z * l.z * reference_brdf(s, v, l, Shading::pbr).x;
                });
                EXPECT_LT(furnace, 1.001) << roughness << ' ' << strength << ' ' << theta;
                EXPECT_GT(furnace, 0.3) << roughness << ' ' << strength << ' ' << theta;
            }
        }
    }
}

Scene lit_metal() { return with_ring_of_lights(brushed_scene()); }

TEST(Anisotropy, EveryRendererShowsTheFloat64Reference) {
    expect_reference_in_every_renderer(lit_metal());
}

TEST(Anisotropy, ListsAndAllLightsAreTheSameBits) { expect_lists_and_all_lights_same(lit_metal()); }

TEST(Anisotropy, AStrengthOfZeroIsTheMaterialWithoutIt) {
    Scene scene = lit_metal(), plain = scene;
    scene.materials[0].anisotropy_texture = add_texel(scene, {255, 128, 0, 255});
    plain.materials[0].anisotropy_strength = 0.0f;
    plain.materials[0].anisotropy_texture = {};
    expect_same_without(scene, plain, &SceneFeatures::anisotropy);
}

// Full strength of a near mirror, under a coat and sheen, on a sphere that a transform mirrors.
TEST(Anisotropy, MirroredTangentsAndEveryLobeAreTheReference) {
    Scene scene = lit_metal();
    Material& m = scene.materials[0];
    m.anisotropy_strength = 1.0f;
    m.roughness = 0.2f;
    m.clearcoat = m.clearcoat_roughness = 0.5f;
    m.sheen_color = glm::vec3(0.2f);
    m.sheen_roughness = 0.5f;
    for (const float handedness : {1.0f, -1.0f}) {
        for (const double mirror : {1.0, -1.0}) {
            for (glm::vec4& tangent : scene.meshes[0].tangents) tangent.w = handedness;
            scene.instances[0].world_from_object[0][0] = mirror;
            const std::vector<double> found = reference_differences(scene, lobe_settings());
            EXPECT_LT(quantile(found, 0.5), 2e-5) << handedness << ' ' << mirror;
            EXPECT_LT(quantile(found, 0.99), 1e-3) << handedness << ' ' << mirror;
        }
    }
}

// A basis of the other hand turns the other way round.
TEST(Anisotropy, RotationsFollowTheHandOfTheBasis) {
    Scene scene = lit_metal();
    scene.materials[0].normal_texture = scene.materials[0].anisotropy_texture = {};
    const auto radiance = [&] {
        return Renderer(scene, lobe_settings()).render(sphere_camera(), 0.0).radiance;
    };
    const std::vector<float> usual = radiance();
    for (glm::vec4& tangent : scene.meshes[0].tangents) tangent.w = -1.0f;
    EXPECT_NE(radiance(), usual);
    scene.materials[0].anisotropy_rotation *= -1.0f;
    EXPECT_EQ(radiance(), usual);
}

// Luminance at equal distances from the highlight in the middle of a plane: along x over along y.
double stretch_along_x(const Scene& scene, double camera_z = 5.0) {
    const Frame frame = Renderer(scene, lobe_settings()).render(front_camera(camera_z), 0.0);
    const auto at = [&](std::size_t x, std::size_t y) {
        return double{luminance_of(frame.radiance, y * 96 + x)};
    };
    return (at(68, 48) + at(27, 48)) / (at(48, 68) + at(48, 27));
}

Scene lit_plane(double light_z) {
    Scene scene = quad_scene();
    scene.meshes[0].tangents.assign(4, {1, 0, 0, 1});
    Material& m = scene.materials[0];
    m.metallic = 1.0f;
    m.roughness = 0.3f;
    m.emissive = glm::vec3(0.0f);
    m.double_sided = true;
    m.anisotropy_strength = 0.8f;
    SceneLight light;
    light.position = {0, 0, light_z};
    light.intensity = glm::vec3(10);
    light.range = 100.0f;
    scene.lights.push_back(light);
    return scene;
}

// "The direction in which highlights will be stretched", by factor, rotation and texture.
TEST(Anisotropy, HighlightsStretchAlongTheDirection) {
    Scene scene = lit_plane(5.0);
    Material& m = scene.materials[0];
    EXPECT_GT(stretch_along_x(scene), 3.0);
    m.anisotropy_rotation = static_cast<float>(std::numbers::pi / 2.0);
    EXPECT_LT(stretch_along_x(scene), 1.0 / 3.0);
    m.anisotropy_texture = add_texel(scene, {128, 255, 255, 255});  // the bitangent, turned to -x
    EXPECT_GT(stretch_along_x(scene), 3.0);
    m.anisotropy_rotation = 0.0f;
    EXPECT_LT(stretch_along_x(scene), 1.0 / 3.0);
    m.anisotropy_texture = add_texel(scene, {128, 255, 0, 255});  // of no strength
    EXPECT_NEAR(stretch_along_x(scene), 1.0, 0.05);
    m.anisotropy_texture = {};
    scene.meshes.push_back(scene.meshes[0]);
    scene.instances.push_back({1, glm::dmat4(1.0)});
    scene.instances[1].world_from_object[3].z = -99.0;
    scene.meshes[0].tangents.clear();
    EXPECT_NEAR(stretch_along_x(scene), 1.0, 0.05) << "no tangents";
}

TEST(Anisotropy, BackFacesStretchTheSameLine) {
    Scene scene = lit_plane(-5.0);
    scene.materials[0].anisotropy_rotation = 0.5f;
    const SurfaceSample seen = center_of(scene, front_camera(-5.0));
    EXPECT_EQ(seen.anisotropy, double{0.8f});
    // x points to the left there.
    const glm::dvec3 line(-std::cos(0.5), std::sin(0.5), 0.0);
    EXPECT_NEAR(std::abs(glm::dot(seen.tangent, line)), 1.0, 1e-6);
    const std::vector<double> found = [&] {
        const Camera camera = front_camera(-5.0);
        const SurfaceSamples samples = RayCaster(scene).cast(camera, 96, 96);
        const ReferencePicture expected =
            shade_reference(samples, reference_lights(scene.lights, camera, &scene),
                            {.shading = Shading::pbr, .ambient = 0.1});
        const Frame frame = Renderer(scene, lobe_settings()).render(camera, 0.0);
        std::vector<double> out;
        for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
            out.push_back(std::abs(frame.radiance[i] / expected.radiance.rgb[i] - 1.0));
        }
        return out;
    }();
    EXPECT_LT(quantile(found, 1.0), 1e-4);
}

}  // namespace
}  // namespace kilolux
