// SPDX-License-Identifier: Apache-2.0
// KHR_materials_sheen: the fit of what it returns, energy, and every renderer against float64 rays.
#include "kernels/shared/lobes/sheen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/measure/reference/reference_brdf.h"
#include "host/measure/reference/reference_sheen.h"
#include "tests/support/lobe_pictures.h"

namespace kilolux {
namespace {

SurfaceSample sheen_surface(double roughness, double albedo = 0.0, double metallic = 0.0) {
    SurfaceSample s;
    s.kind = SurfaceKind::lit;
    s.normal = {0, 0, 1};
    s.albedo = glm::dvec3(albedo);
    s.metallic = metallic;
    s.roughness = 1.0;
    s.specular = glm::dvec3(0.0);
    s.specular_f90 = 0.0;
    s.sheen = glm::dvec3(1.0);
    s.sheen_roughness = roughness;
    return s;
}

// The integral over the hemisphere of what the surface sends to the eye. Samples crowd at grazing
// angles, and towards and away from the eye.
double returned(const SurfaceSample& s, double n_dot_v) {
    constexpr int kRings = 200, kColumns = 80;
    const glm::dvec3 v(std::sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v);
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
        const double u = (i + 0.5) / kRings, z = u * u, sine = std::sqrt(1 - z * z);
        for (int j = 0; j < kColumns; ++j) {
            const double t = std::numbers::pi * (j + 0.5) / kColumns;
            const double around = std::numbers::pi * (1 - std::cos(t)) / 2;
            const glm::dvec3 l(sine * std::cos(around), sine * std::sin(around), z);
            const double weight =
                2 * u / kRings * std::numbers::pi * std::numbers::pi * std::sin(t) / kColumns;
            sum += weight * reference_reflection(s, v, l, Shading::pbr).x;
        }
    }
    return sum;
}

// Differences of SHEEN_ALBEDO_ROWS from the integrals of the lobe over black.
TEST(Sheen, AlbedosAreIntegralsOfTheLobe) {
    double worst = 0.0, grazing = 0.0;
    for (int i = 0; i <= 12; ++i) {
        const double roughness = std::pow(i / 12.0, 1.5);
        for (int k = 0; k <= 16; ++k) {
            const double x = std::max(std::pow(k / 16.0, 1.7), 1e-4);
            const double expected = std::min(returned(sheen_surface(roughness), x), 1.0);
            double& of = x > 0.009 ? worst : grazing;
            of = std::max(of, std::abs(reference_sheen_albedo(x, roughness) - expected));
        }
    }
    EXPECT_LT(worst, 0.013);
    EXPECT_LT(grazing, 0.2);
}

// The bound of errors by nodes of lights.
TEST(Sheen, AlbedosAreNoSteeperThanTheirBound) {
    for (double roughness = 0.045; roughness <= 1.0; roughness += 0.005) {
        for (double x = 0.0; x < 1.0; x += 1e-3) {
            const double rise =
                reference_sheen_albedo(x + 1e-3, roughness) - reference_sheen_albedo(x, roughness);
            ASSERT_LT(std::abs(rise) / 1e-3, SHEEN_SLOPE + SHEEN_SLOPE_BY_R / roughness)
                << roughness << ' ' << x;
        }
    }
}

// White furnace: over a white diffuse surface sheen adds no light but at grazing angles, where the
// model's narrow lobes return more than arrives.
TEST(Sheen, AddsNoLightInAWhiteFurnace) {
    for (const double roughness : {0.0, 0.1, 0.3, 0.5, 1.0}) {
        for (const double x : {0.3, 0.5, 0.8, 1.0}) {
            const double furnace = returned(sheen_surface(roughness, 1.0), x);
            EXPECT_LT(furnace, 1.015) << roughness << ' ' << x;
            EXPECT_GT(furnace, 0.6) << roughness << ' ' << x;
        }
    }
}

TEST(Sheen, IsReciprocal) {
    for (int i = 0; i < 200; ++i) {
        const SurfaceSample s = sheen_surface(0.05 + 0.0047 * i, 0.5);
        const auto direction = [](double theta, double phi) {
            return glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                              std::cos(theta));
        };
        const glm::dvec3 a = direction(0.007 * i + 0.1, 0.0),
                         b = direction(1.5 - 0.005 * i, 0.3 * i);
        const double there = reference_reflection(s, a, b, Shading::pbr).x / b.z;
        EXPECT_NEAR(reference_reflection(s, b, a, Shading::pbr).x / a.z, there, 1e-12 * there) << i;
    }
}

Scene lit_cloth() { return with_ring_of_lights(cloth_scene()); }

TEST(Sheen, EveryRendererShowsTheFloat64Reference) {
    expect_reference_in_every_renderer(lit_cloth());
}

TEST(Sheen, ListsAndAllLightsAreTheSameBits) { expect_lists_and_all_lights_same(lit_cloth()); }

TEST(Sheen, ABlackTextureIsTheMaterialWithoutIt) {
    Scene scene = lit_cloth(), plain = scene;
    scene.materials[0].sheen_color_texture = add_texel(scene, {0, 0, 0, 255});
    plain.materials[0].sheen_color = glm::vec3(0.0f);
    expect_same_without(scene, plain, &SceneFeatures::sheen);
}

}  // namespace
}  // namespace kilolux
