// SPDX-License-Identifier: Apache-2.0
// The light of one light at one point, on the device, against double: the numerically hard cases.
#include "kernels/shared/evaluate_modes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/opencl/shading/evaluate_probe.h"

namespace kilolux {
namespace {

// Relative to the larger of the radiance and the sum of intensity * falloff: u = 6e-8 times the
// dozens of operations of a term.
constexpr double kEvaluateTolerance = 1e-5;

constexpr int kShadings[] = {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR};

float f(double x) { return static_cast<float>(x); }

ShadeLight light_at(glm::dvec3 p, double range, glm::dvec3 intensity) {
    return {{f(p.x), f(p.y), f(p.z), f(1 / (range * range))},
            {f(intensity.x), f(intensity.y), f(intensity.z), 1.0f},
            {0.0f, 0.0f, 0.0f, -1.0f}};
}

ShadeLight spot_at(glm::dvec3 p, double range, glm::dvec3 axis, double outer) {
    ShadeLight light = light_at(p, range, {3, 2, 1});
    light.color_scale.w = f(1 / std::max(0.001, 0.3 * (1 - std::cos(outer))));
    light.axis_cos = {f(axis.x), f(axis.y), f(axis.z), f(std::cos(outer))};
    return light;
}

// Each surface of the probe against the reference.
double worst_error(const std::vector<SurfaceD>& surfaces, const Lighting& lighting, int lanes = 0) {
    const ProbeResult found = probe_evaluate(surfaces, lighting, lanes);
    double worst = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const ReferenceRadiance expected = reference_radiance(found.surfaces[i], lighting);
        worst = std::max(worst, relative_error(found.radiance[i], expected));
    }
    return worst;
}

SurfaceD random_surface(Random& random, double roughness_min) {
    SurfaceD s;
    const double z = random.log_uniform(0.5, 20);
    s.position = {z * random.uniform(-1, 1), z * random.uniform(-1, 1), -z};
    // Facing the eye, perspective or not, like visible surfaces: where n.h <= 0, Blinn-Phong's
    // exponents below 1 have infinite slope.
    do {
        s.normal = random.direction();
    } while (s.normal.z < 0 || dot(s.normal, s.position) > 0);
    s.albedo = {random.unit(), random.unit(), random.unit()};
    s.emissive = s.albedo * 0.01;
    s.roughness = random.uniform(roughness_min, 1);
    s.metallic = random.below(3) * 0.5;
    s.occlusion = random.unit();
    if (random.below(2) == 0) return s;
    // Values that KHR_materials_specular and KHR_materials_ior allow: tinted, weighted, up to a
    // mirror.
    s.specular_f90 = random.below(4) * (1.0 / 3.0);
    s.specular = glm::dvec3{random.unit(), random.unit(), random.unit()} * s.specular_f90;
    return s;
}

// With a coat whose normal is near the surface's.
SurfaceD coated_surface(Random& random, double roughness_min) {
    SurfaceD s = random_surface(random, roughness_min);
    s.coat = random.below(3) * 0.5;
    s.coat_roughness = random.uniform(roughness_min, 1);
    do {
        s.coat_normal = glm::normalize(s.normal + 0.5 * random.direction());
    } while (s.coat_normal.z < 0 || dot(s.coat_normal, s.position) > 0);
    return s;
}

// With sheen, half of them under a coat.
SurfaceD sheen_surface(Random& random) {
    SurfaceD s = random.below(2) == 0 ? random_surface(random, 0.3) : coated_surface(random, 0.3);
    s.sheen = {random.unit(), random.unit(), random.unit()};
    s.sheen_roughness = random.uniform(0.3, 1);
    return s;
}

glm::dvec3 tangent_of(const SurfaceD& s, Random& random) {
    return glm::normalize(cross(s.normal, random.direction()));
}

// With stretched highlights, half of them under a coat.
SurfaceD stretched_surface(Random& random) {
    SurfaceD s = random.below(2) == 0 ? random_surface(random, 0.3) : coated_surface(random, 0.3);
    s.tangent = tangent_of(s, random);
    s.anisotropy = random.below(5) * 0.25;
    return s;
}

TEST(Evaluate, AgreesWithDoubleForPointSpotAndDirectionalLights) {
    Random random(21);
    std::vector<ShadeLight> lights;
    for (int i = 0; i < 40; ++i) {
        const glm::dvec3 p{random.uniform(-10, 10), random.uniform(-10, 10),
                           random.uniform(-20, 2)};
        const double range = random.log_uniform(1, 40);
        lights.push_back(i % 2 == 0
                             ? light_at(p, range, {random.unit(), 5, 2})
                             : spot_at(p, range, random.direction(), random.uniform(0.1, 1.57)));
    }
    const std::vector<DirectionalLight> sun = {
        {{0.6f, 0.64f, 0.48f, 0.0f}, {1.0f, 0.9f, 0.8f, 0.0f}}};
    std::vector<SurfaceD> surfaces;
    for (int i = 0; i < 3000; ++i) surfaces.push_back(random_surface(random, 0.3));
    for (int i = 0; i < 3000; ++i) surfaces.push_back(coated_surface(random, 0.3));
    for (int i = 0; i < 3000; ++i) surfaces.push_back(sheen_surface(random));
    for (int i = 0; i < 3000; ++i) surfaces.push_back(stretched_surface(random));
    for (const int shading : kShadings) {
        for (const bool orthographic : {false, true}) {
            const Lighting all{lights, sun, 0.1, orthographic, shading};
            EXPECT_LE(worst_error(surfaces, all), kEvaluateTolerance) << "shading " << shading;
            const Lighting none{{}, {}, 0.1, orthographic, shading};
            EXPECT_LE(worst_error(surfaces, none), kEvaluateTolerance)
                << "shading " << shading << ", no lights";
        }
    }
}

TEST(Evaluate, NormalsThatFaceAwayFromTheEyeStayAccurate) {
    Random random(22);
    std::vector<SurfaceD> surfaces;
    for (int i = 0; i < 1000; ++i) {
        surfaces.push_back(random_surface(random, 0.3));
        surfaces.back().normal = surfaces.back().normal * -1.0;
    }
    const std::vector<ShadeLight> lights = {light_at({1, 2, -30}, 90, {1, 2, 3}),
                                            light_at({0, -5, -9}, 90, {1, 2, 3})};
    for (const int shading : {SHADING_LAMBERT, SHADING_PBR}) {
        EXPECT_LE(worst_error(surfaces, {lights, {}, 0, false, shading}), kEvaluateTolerance)
            << "shading " << shading;
    }
}

TEST(Evaluate, LightAtTheShadingPointIsFinite) {
    SurfaceD s;
    s.position = {0.25, -0.5, -2};
    s.normal = {0, 0, 1};
    s.roughness = 0.5;
    for (const int shading : kShadings) {
        for (const double d :
             {0.0, 1e-30, 1e-20, 1e-10, 1e-7, 1e-5, 1e-4, 1e-3, 0.0099, 0.01, 0.0101}) {
            for (const glm::dvec3& direction : {glm::dvec3{0, 0, 1}, glm::dvec3{0.6, 0, 0.8},
                                                glm::dvec3{1, 0, 0}, glm::dvec3{0, 0, -1}}) {
                const std::vector<ShadeLight> lights = {
                    light_at(s.position + direction * d, 3, {1, 1, 1})};
                const Lighting lighting{lights, {}, 0, false, shading};
                // I / LIGHT_D_MIN^2 is the largest irradiance.
                EXPECT_LE(worst_error({s}, lighting), kEvaluateTolerance)
                    << "shading " << shading << ", d = " << d;
            }
        }
    }
}

TEST(Evaluate, HugeAndTinyIntensitiesStayAccurate) {
    Random random(4);
    std::vector<SurfaceD> surfaces;
    for (int i = 0; i < 64; ++i) surfaces.push_back(random_surface(random, 0.3));
    for (const int shading : kShadings) {
        for (const double intensity : {1e30, 1e20, 1e6, 1e-6, 1e-25}) {
            std::vector<ShadeLight> lights;
            for (int i = 0; i < 1000; ++i) {
                lights.push_back(
                    light_at({random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-9, 1)},
                             50, glm::dvec3{1, 0.5, 0.25} * intensity));
            }
            for (SurfaceD& s : surfaces) s.emissive = {};
            EXPECT_LE(worst_error(surfaces, {lights, {}, 0, false, shading}), kEvaluateTolerance)
                << "shading " << shading << ", intensity " << intensity;
        }
    }
}

TEST(Evaluate, SumsAHundredThousandLightsAccurately) {
    Random random(6);
    std::vector<ShadeLight> lights;
    for (int i = 0; i < 100000; ++i) {
        const double intensity = std::exp(random.uniform(-6, 6));
        lights.push_back(
            light_at({random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-9, 1)}, 50,
                     {intensity, 1, intensity}));
    }
    std::vector<SurfaceD> surfaces;
    for (int i = 0; i < 8; ++i) surfaces.push_back(random_surface(random, 0.3));
    // Blocks of 64 bound the sum's own rounding by 64 u + k / 64 u; it is far less on average.
    EXPECT_LE(worst_error(surfaces, {lights, {}, 0, false, SHADING_LAMBERT}), kEvaluateTolerance);
}

TEST(Evaluate, GrazingLightIsAccurateAndNeverLeaksToTheBack) {
    std::vector<SurfaceD> surfaces(1);
    surfaces[0].position = {0, 0, -4};
    surfaces[0].normal = {0, 0, 1};
    for (const double angle : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
        for (const double sign : {1.0, -1.0}) {
            const glm::dvec3 to_light{std::cos(angle), 0, sign * std::sin(angle)};
            const std::vector<ShadeLight> lights = {
                light_at(surfaces[0].position + to_light * 2.0, 9, {1, 1, 1})};
            const Lighting lighting{lights, {}, 0, false, SHADING_LAMBERT};
            EXPECT_LE(worst_error(surfaces, lighting), 1e-6) << "angle " << sign * angle;
            if (sign < 0 && angle > 2e-7) {
                EXPECT_EQ(probe_evaluate(surfaces, lighting).radiance[0].x, 0.0)
                    << "angle " << angle;
            }
        }
    }
}

TEST(Evaluate, HugeIntensityInAMirrorStaysFinite) {
    std::vector<SurfaceD> surfaces(1);
    surfaces[0].position = {0, 0, -3};
    surfaces[0].normal = {0, 0, 1};
    surfaces[0].roughness = 0;
    for (const int shading : kShadings) {
        const std::vector<ShadeLight> lights = {light_at({0, 0, 0}, 50, {1e30, 1e25, 1})};
        // Tolerates some ulp of alpha, of which the peak is the inverse square.
        const Lighting lighting{lights, {}, 0, false, shading};
        EXPECT_LE(worst_error(surfaces, lighting), kEvaluateTolerance) << "shading " << shading;
    }
}

// Surfaces in a row whose half vectors sweep away from the normal; eye and light both straight
// above.
std::vector<SurfaceD> lobe_sweep(double roughness) {
    std::vector<SurfaceD> surfaces;
    for (int i = -500; i <= 500; ++i) {
        const double angle = 4 * roughness * roughness * i / 500.0;
        SurfaceD s;
        s.position = {0, 0, -3};
        s.normal = {std::sin(angle), 0, std::cos(angle)};
        s.roughness = roughness;
        s.metallic = 1;
        s.albedo = {1, 1, 1};
        surfaces.push_back(s);
    }
    return surfaces;
}

void expect_lobe(const std::vector<SurfaceD>& sweep, int shading, double tolerance) {
    const std::vector<ShadeLight> lights = {light_at({1e-3, 0, 0}, 50, {1, 1, 1})};
    const Lighting lighting{lights, {}, 0, false, shading};
    const ProbeResult found = probe_evaluate(sweep, lighting);
    double peak = 0;
    for (const SurfaceD& s : found.surfaces)
        peak = std::max(peak, reference_radiance(s, lighting).value.x);
    for (std::size_t i = 0; i < found.radiance.size(); ++i) {
        const double expected = reference_radiance(found.surfaces[i], lighting).value.x;
        ASSERT_NEAR(found.radiance[i].x / peak, expected / peak, tolerance)
            << "roughness " << sweep[i].roughness << ", sample " << i;
    }
}

TEST(Evaluate, SpecularPeaksKeepTheirShape) {
    // Roughness 0 is clamped to 0.045, alpha 0.002. Exponents: 0.119 gives 1e4.
    for (const double roughness : {0.0, 0.045, 0.06, 0.1, 0.3, 0.6, 1.0})
        expect_lobe(lobe_sweep(roughness), SHADING_PBR, 5e-5);
    for (const double roughness : {0.119, 0.2, 0.5, 1.0})
        expect_lobe(lobe_sweep(roughness), SHADING_BLINN_PHONG, 1e-5);
}

// The same sweep of a coat over a black surface that reflects nothing itself.
TEST(Evaluate, PeaksOfCoatsKeepTheirShape) {
    for (const double roughness : {0.0, 0.045, 0.1, 0.3, 1.0}) {
        std::vector<SurfaceD> surfaces = lobe_sweep(roughness);
        for (SurfaceD& s : surfaces) {
            s.coat = 1;
            s.coat_roughness = roughness;
            s.coat_normal = s.normal;
            s.normal = {0, 0, 1};
            s.albedo = s.specular = {};
            s.specular_f90 = s.metallic = 0;
            s.roughness = 1;
        }
        expect_lobe(surfaces, SHADING_PBR, 5e-5);
    }
}

// The same sweep across highlights that are stretched along y.
TEST(Evaluate, StretchedPeaksKeepTheirShape) {
    for (const double roughness : {0.0, 0.045, 0.1, 0.3, 1.0}) {
        for (const double strength : {0.01, 0.3, 1.0}) {
            std::vector<SurfaceD> surfaces = lobe_sweep(roughness);
            for (SurfaceD& s : surfaces) {
                s.tangent = {0, 1, 0};
                s.anisotropy = strength;
            }
            expect_lobe(surfaces, SHADING_PBR, 5e-5);
            // And along it.
            for (SurfaceD& s : surfaces) s.tangent = cross(s.normal, s.tangent);
            expect_lobe(surfaces, SHADING_PBR, 5e-5);
        }
    }
}

TEST(Evaluate, StretchedHighlightsSeenAtGrazingAnglesStayAccurate) {
    Random random(30);
    std::vector<SurfaceD> surfaces;
    for (const double cosine : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0}) {
        for (int i = 0; i < 64; ++i) {
            SurfaceD s;
            s.position = {0, 0, -3};
            s.normal = {std::sqrt(1 - cosine * cosine), 0, cosine};
            s.roughness = 0.4;
            s.metallic = 1;
            s.tangent = tangent_of(s, random);
            s.anisotropy = random.below(5) * 0.25;
            surfaces.push_back(s);
        }
    }
    const std::vector<ShadeLight> lights = {light_at({2, 0.5, -4}, 50, {1, 2, 3})};
    EXPECT_LE(worst_error(surfaces, {lights, {}, 0.1, false, SHADING_PBR}), kEvaluateTolerance);
}

// A strength of 0 changes no bit, also of a mirror.
TEST(Evaluate, AnisotropyOfNoStrengthChangesNoBit) {
    Random random(31);
    std::vector<SurfaceD> surfaces;
    for (int i = 0; i < 500; ++i) {
        surfaces.push_back(coated_surface(random, 0.3));
        surfaces.back().roughness = i % 3 * 0.2;
        surfaces.back().tangent = tangent_of(surfaces.back(), random);
    }
    const std::vector<ShadeLight> lights = {light_at({0.1, 0.2, 0.3}, 90, {1, 2, 3}),
                                            light_at({3, 2, -5}, 90, {1, 2, 3})};
    Lighting lighting{lights, {}, 0.1, false, SHADING_PBR};
    for (const int lanes : {1, 8}) {
        lighting.anisotropy = true;
        const ProbeResult with = probe_evaluate(surfaces, lighting, lanes);
        lighting.anisotropy = false;
        const ProbeResult without = probe_evaluate(surfaces, lighting, lanes);
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            ASSERT_EQ(with.radiance[i], without.radiance[i]) << i;
        }
    }
}

TEST(Evaluate, CoatsSeenAtGrazingAnglesStayAccurate) {
    std::vector<SurfaceD> surfaces;
    for (const double cosine : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0}) {
        SurfaceD s;
        s.position = {0, 0, -3};
        s.normal = s.coat_normal = {std::sqrt(1 - cosine * cosine), 0, cosine};
        s.coat = 1;
        s.coat_roughness = 0.4;
        surfaces.push_back(s);
    }
    const std::vector<ShadeLight> lights = {light_at({2, 0.5, -4}, 50, {1, 2, 3})};
    EXPECT_LE(worst_error(surfaces, {lights, {}, 0.1, false, SHADING_PBR}), kEvaluateTolerance);
}

// A factor of 0 changes no bit, also where the coat's lobe overflows.
TEST(Evaluate, CoatsOfNoFactorChangeNoBit) {
    Random random(23);
    std::vector<SurfaceD> surfaces;
    for (int i = 0; i < 500; ++i) {
        surfaces.push_back(random_surface(random, 0.3));
        surfaces.back().coat_roughness = 0;
        // At the peak of the first light.
        const glm::dvec3 p = surfaces.back().position;
        surfaces.back().coat_normal =
            glm::normalize(glm::normalize(glm::dvec3(0.1, 0.2, 0.3) - p) - glm::normalize(p));
    }
    for (const double intensity : {1.0, 1e35}) {
        const std::vector<ShadeLight> lights = {
            light_at({0.1, 0.2, 0.3}, 90, glm::dvec3(1, 2, 3) * intensity),
            light_at({3, 2, -5}, 90, glm::dvec3(1, 2, 3) * intensity)};
        Lighting lighting{lights, {}, 0.1, false, SHADING_PBR};
        const ProbeResult with = probe_evaluate(surfaces, lighting);
        lighting.clearcoat = false;
        const ProbeResult without = probe_evaluate(surfaces, lighting);
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            ASSERT_EQ(with.radiance[i], without.radiance[i]) << i << ", intensity " << intensity;
        }
    }
}

// Sheen of every roughness and cosine to the eye and, by turns, to the light; 0 is clamped.
TEST(Evaluate, SheenOfAnyRoughnessIsAccurateAtAnyAngle) {
    const std::vector<ShadeLight> lights = {light_at({2, 0.5, -4}, 50, {1, 2, 3})};
    for (const double roughness : {0.0, 0.045, 0.1, 0.3, 1.0}) {
        std::vector<SurfaceD> surfaces;
        for (const double cosine : {1.0, 0.5, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0}) {
            for (const double around : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
                const double sine = std::sqrt(1 - cosine * cosine);
                SurfaceD s;
                s.position = {0, 0, -3};
                s.normal = {sine * std::cos(around), sine * std::sin(around), cosine};
                s.sheen = {0.2, 0.9, 1};
                s.sheen_roughness = roughness;
                surfaces.push_back(s);
                // The same angle to the light.
                const glm::dvec3 l = glm::normalize(glm::dvec3(2, 0.5, -1));
                const glm::dvec3 side = glm::normalize(cross(l, glm::dvec3(0, 0, 1)));
                s.normal = l * cosine +
                           (cross(l, side) * std::cos(around) + side * std::sin(around)) * sine;
                if (s.normal.z > 0) surfaces.push_back(s);
            }
        }
        // The exponent of a narrow lobe magnifies the rounding of sin^2, up to 250 times.
        const double tolerance = roughness < 0.3 ? 2e-4 : kEvaluateTolerance;
        EXPECT_LE(worst_error(surfaces, {lights, {}, 0.1, false, SHADING_PBR}), tolerance)
            << roughness;
    }
}

// A black sheen changes no bit, also where its lobe overflows.
TEST(Evaluate, SheenOfNoColorChangesNoBit) {
    Random random(29);
    std::vector<SurfaceD> surfaces;
    for (int i = 0; i < 500; ++i) {
        surfaces.push_back(random_surface(random, 0.3));
        surfaces.back().sheen_roughness = 0;
        // Seen almost edge-on, half of them: there the lobe is brightest.
        const glm::dvec3 eye = -glm::normalize(surfaces.back().position);
        const glm::dvec3 side = glm::normalize(cross(eye, random.direction()));
        if (i % 2 == 0) surfaces.back().normal = glm::normalize(side + 0.05 * eye);
    }
    for (const double intensity : {1.0, 5e37}) {
        const std::vector<ShadeLight> lights = {
            light_at({0.1, 0.2, 0.3}, 90, glm::dvec3(1, 2, 3) * intensity),
            light_at({3, 2, -5}, 90, glm::dvec3(1, 2, 3) * intensity)};
        Lighting lighting{lights, {}, 0.1, false, SHADING_PBR};
        const ProbeResult with = probe_evaluate(surfaces, lighting);
        lighting.sheen = false;
        const ProbeResult without = probe_evaluate(surfaces, lighting);
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            ASSERT_EQ(with.radiance[i], without.radiance[i]) << i << ", intensity " << intensity;
        }
    }
}

TEST(Evaluate, PowersOfCosinesAreAccurateAtAnyExponent) {
    Random random(8);
    std::vector<float> sin2, n;
    for (const double exponent : {0.0, 1e-3, 0.5, 1.0, 2.0, 3.7, 32.0, 1e3, 1e4, 1e5}) {
        for (const double base : {0.0, 1e-38, 1e-10, 0.25, 0.29289, 0.5, 0.999999, 1.0}) {
            sin2.push_back(f(base));
            n.push_back(f(exponent));
        }
        for (int i = 0; i < 2000; ++i) {
            // Where the power falls from 1 to 1e-9, and anywhere.
            const double slope = std::min(1.0, 20 * random.unit() / std::max(exponent, 1.0));
            sin2.push_back(f(i % 2 == 0 ? slope : random.unit()));
            n.push_back(f(exponent));
        }
    }
    for (const int lanes : {1, 8}) {
        const std::vector<float> found = probe_pow_of_cos2(sin2, n, lanes);
        for (std::size_t i = 0; i < sin2.size(); ++i) {
            const long double expected =
                n[i] == 0.0f ? 1.0L : std::pow(1.0L - sin2[i], static_cast<long double>(n[i]));
            // At 90 degrees the power is 0 but for tiny exponents: of 0 it is 2^-130n here.
            if (sin2[i] == 1.0f && n[i] < 1.0f) continue;
            ASSERT_NEAR(found[i], static_cast<double>(expected), 2e-7)
                << "sin^2 = " << sin2[i] << ", n = " << n[i];
            ASSERT_LE(found[i], 1.0f + 2e-7f);
            ASSERT_GE(found[i], 0.0f);
        }
    }
}

}  // namespace
}  // namespace kilolux
