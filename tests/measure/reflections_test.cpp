// SPDX-License-Identifier: Apache-2.0
// An environment by prefiltered maps against the float64 integral of the same BRDF over all of its
// pixels, on a sphere.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/reference_brdf.h"
#include "host/render/renderer.h"
#include "tests/support/sphere_scene.h"

namespace kilolux {
namespace {

using RadianceOf = std::function<glm::dvec3(const glm::dvec3&)>;

struct Map {
    Environment whole;
    std::shared_ptr<const PrefilteredEnvironment> filtered;
};

Map map_of(const RadianceOf& radiance) {
    Environment out{256, 128, {}};
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) out.rows.emplace_back(radiance(out.direction(x, y)));
    }
    return {out, std::make_shared<const PrefilteredEnvironment>(prefiltered(out))};
}

// A bright window, a dim one, and a gradient.
glm::dvec3 room(const glm::dvec3& d) {
    const auto lobe = [&](const glm::dvec3& towards, double width) {
        return std::exp((glm::dot(d, glm::normalize(towards)) - 1.0) / (width * width));
    };
    return glm::dvec3(0.2, 0.25, 0.3) * (1.0 + 0.5 * d.y) +
           lobe({-0.8, 0.9, 1.2}, 0.25) * glm::dvec3(6.0, 5.5, 5.0) +
           lobe({1.0, 0.2, 0.3}, 0.4) * glm::dvec3(1.0, 1.2, 1.5);
}

Material material_of(double roughness, double metallic) {
    Material out;
    out.base_color = {0.9f, 0.6f, 0.3f, 1.0f};
    out.roughness = static_cast<float>(roughness);
    out.metallic = static_cast<float>(metallic);
    return out;
}

struct Pictures {
    std::vector<glm::dvec3> seen, expected;  // at the surface pixels
    std::vector<SurfaceSample> surfaces;
    Camera camera;

    // Root mean square of the difference, relative to the mean.
    double error() const {
        double squares = 0.0, sum = 0.0;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            squares += glm::dot(seen[i] - expected[i], seen[i] - expected[i]);
            sum += glm::length(expected[i]);
        }
        const auto count = static_cast<double>(seen.size());
        return std::sqrt(squares / count) / (sum / count);
    }
};

glm::dvec3 integral(const Environment& map, const SurfaceSample& s, const Camera& camera) {
    const glm::dvec3 to_eye = -glm::normalize(s.position);
    glm::dvec3 out(0.0);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec3 to_light = map.direction(x, y) * camera.world_from_view;
            out += map.light(x, y) * reference_reflection(s, to_eye, to_light, Shading::pbr);
        }
    }
    return s.occlusion * out;
}

Pictures pictures(const Map& map, const Material& material, bool with_integral = true) {
    const Scene scene = sphere_scene(material);
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.lights.count = 0;
    settings.ambient = 0.0f;
    settings.gbuffer = GBUFFER_FULL;
    settings.shading = Shading::pbr;
    settings.reflections = map.filtered;
    Renderer renderer(scene, settings);
    Pictures out;
    out.camera = look_at({0.5, 0.8, 4.0}, {0, 0, 0}, {0, 1, 0}, 0.55);
    const Frame frame = renderer.render(out.camera, 0.0);
    const SurfaceSamples samples = surface_samples(renderer.lit_surfaces().surfaces);
    for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
        const SurfaceSample& s = samples.pixels[i];
        const glm::dvec3 seen(frame.radiance[3 * i], frame.radiance[3 * i + 1],
                              frame.radiance[3 * i + 2]);
        if (s.kind == SurfaceKind::background) {
            EXPECT_EQ(seen, glm::dvec3(0.0));
            continue;
        }
        // Seen edge-on, reflectance rises within a step of the table.
        if (glm::dot(s.normal, -glm::normalize(s.position)) < 0.1) continue;
        out.seen.push_back(seen);
        out.surfaces.push_back(s);
        if (with_integral) out.expected.push_back(integral(map.whole, s, out.camera));
    }
    EXPECT_GT(out.seen.size(), 100u);
    return out;
}

// The table that README.md quotes.
TEST(Reflections, ErrorsAreThoseOfTheSplitSum) {
    struct Row {
        double roughness, metallic, most;
    };
    const Map map = map_of(room);
    for (const Row& row : {Row{0.25, 1, 0.05}, Row{0.5, 1, 0.13}, Row{1.0, 1, 0.12},
                           Row{0.25, 0, 0.01}, Row{0.5, 0, 0.01}, Row{1.0, 0, 0.01}}) {
        const double error = pictures(map, material_of(row.roughness, row.metallic)).error();
        EXPECT_LT(error, row.most) << "roughness " << row.roughness << " metallic " << row.metallic;
    }
}

// A constant environment needs no filter: only the table's error remains.
TEST(Reflections, AWhiteRoomIsReflectedExactly) {
    const Map map = map_of([](const glm::dvec3&) { return glm::dvec3(1.0); });
    for (const double roughness : {0.25, 1.0}) {
        EXPECT_LT(pictures(map, material_of(roughness, 1.0)).error(), 0.01) << roughness;
        EXPECT_LT(pictures(map, material_of(roughness, 0.0)).error(), 0.01) << roughness;
    }
}

Material coated(double roughness) {
    Material out = material_of(1.0, 1.0);
    out.clearcoat = 1.0f;
    out.clearcoat_roughness = static_cast<float>(roughness);
    return out;
}

// The coat's layer has a reflectance of 1 below its Fresnel term.
TEST(Reflections, CoatsReflectTheRoomOverWhatIsBelow) {
    const Map white = map_of([](const glm::dvec3&) { return glm::dvec3(1.0); });
    const Map map = map_of(room);
    for (const double roughness : {0.25, 0.5, 1.0}) {
        EXPECT_LT(pictures(white, coated(roughness)).error(), 0.01) << roughness;
        Material varnish = coated(roughness);
        varnish.metallic = 0.0f;
        EXPECT_LT(pictures(map, varnish).error(), 0.02) << roughness;
    }
}

Material cloth(double roughness) {
    Material out = material_of(1.0, 0.0);
    out.sheen_color = {0.9f, 0.9f, 0.9f};
    out.sheen_roughness = static_cast<float>(roughness);
    return out;
}

// The base is dimmed for the eye's direction alone, not for that of each light: most of the error.
TEST(Reflections, SheenReflectsTheRoomOverWhatIsBelow) {
    const Map white = map_of([](const glm::dvec3&) { return glm::dvec3(1.0); });
    const Map map = map_of(room);
    for (const double roughness : {0.25, 1.0}) {
        EXPECT_LT(pictures(white, cloth(roughness)).error(), 0.07) << roughness;
        EXPECT_LT(pictures(map, cloth(roughness)).error(), 0.09) << roughness;
    }
}

Material brushed_metal(double roughness, double strength) {
    Material out = material_of(roughness, 1.0);
    out.anisotropy_strength = static_cast<float>(strength);
    out.anisotropy_rotation = 0.5f;
    return out;
}

// A few narrow lobes stand for a stretched one.
TEST(Reflections, StretchedHighlightsReflectTheRoom) {
    const Map white = map_of([](const glm::dvec3&) { return glm::dvec3(1.0); });
    const Map map = map_of(room);
    for (const double roughness : {0.25, 0.5}) {
        for (const double strength : {0.25, 0.5, 1.0}) {
            const Material metal = brushed_metal(roughness, strength);
            EXPECT_LT(pictures(white, metal).error(), 0.1) << roughness << ' ' << strength;
            EXPECT_LT(pictures(map, metal).error(), 0.22) << roughness << ' ' << strength;
        }
    }
    EXPECT_LT(pictures(map, brushed_metal(1.0, 1.0)).error(), 0.12) << "as wide along as across";
}

TEST(Reflections, AMirrorShowsTheRoom) {
    Material mirror = material_of(0.0, 1.0);
    mirror.base_color = glm::vec4(1.0f);
    const auto around = [](const glm::dvec3& d) { return 0.6 + 0.5 * d; };
    const Pictures p = pictures(map_of(around), mirror, false);
    for (std::size_t i = 0; i < p.seen.size(); ++i) {
        const SurfaceSample& s = p.surfaces[i];
        const glm::dvec3 to_eye = -glm::normalize(s.position);
        const glm::dvec3 d =
            p.camera.world_from_view * (2.0 * glm::dot(s.normal, to_eye) * s.normal - to_eye);
        EXPECT_LT(glm::length(p.seen[i] - around(d)), 0.02) << i;
    }
}

}  // namespace
}  // namespace kilolux
