// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/reference_brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace kilolux {
namespace {

const glm::dvec3 kUp{0.0, 0.0, 1.0};

SurfaceSample surface(double roughness, double metallic, glm::dvec3 albedo = {0.8, 0.5, 0.2}) {
    SurfaceSample s;
    s.albedo = albedo;
    s.roughness = roughness;
    s.metallic = metallic;
    s.specular = glm::dvec3(0.04);  // the default is a float
    s.kind = SurfaceKind::lit;
    return s;
}

glm::dvec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Integral of brdf * cos over the hemisphere of light directions, midpoint rule.
double directional_albedo(const SurfaceSample& s, const glm::dvec3& to_eye, Shading model) {
    constexpr int kTheta = 400, kPhi = 400;
    double sum = 0.0;
    for (int i = 0; i < kTheta; ++i) {
        const double theta = (i + 0.5) * (std::numbers::pi / 2) / kTheta;
        for (int j = 0; j < kPhi; ++j) {
            const glm::dvec3 l = direction(theta, (j + 0.5) * 2 * std::numbers::pi / kPhi);
            sum += reference_brdf(s, to_eye, l, model).x * std::cos(theta) * std::sin(theta);
        }
    }
    return sum * (std::numbers::pi / 2 / kTheta) * (2 * std::numbers::pi / kPhi);
}

TEST(ReferenceBrdf, LambertReflectsItsAlbedo) {
    const SurfaceSample s = surface(0.5, 0.0);
    EXPECT_DOUBLE_EQ(reference_brdf(s, kUp, kUp, Shading::lambert).y, 0.5 / std::numbers::pi);
    EXPECT_NEAR(directional_albedo(s, kUp, Shading::lambert), 0.8, 1e-5);
}

TEST(ReferenceBrdf, PbrStraightAheadIsTheClosedForm) {
    for (const double roughness : {0.0, 0.045, 0.3, 1.0}) {
        for (const double metallic : {0.0, 0.25, 1.0}) {
            const SurfaceSample s = surface(roughness, metallic);
            const double alpha = std::pow(std::max(roughness, 0.045), 2);
            const double f0 = 0.04 * (1 - metallic) + 0.8 * metallic;
            const double diffuse = (1 - metallic) * 0.8 / std::numbers::pi * (1 - f0);
            const double expected = diffuse + f0 / (4 * std::numbers::pi * alpha * alpha);
            const double value = reference_brdf(s, kUp, kUp, Shading::pbr).x;
            EXPECT_NEAR(value, expected, 1e-12 * expected) << roughness << ' ' << metallic;
        }
    }
}

TEST(ReferenceBrdf, PbrMatchesTheFormulasInAngles) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 2000; ++i) {
        const SurfaceSample s = surface(0.1 + 0.9 * unit(random), unit(random));
        const glm::dvec3 v = direction(1.5 * unit(random), 6.28 * unit(random));
        const glm::dvec3 l = direction(1.5 * unit(random), 6.28 * unit(random));
        const glm::dvec3 h = glm::normalize(v + l);
        const double a = s.roughness * s.roughness;
        // GGX and Smith's lambda in tangents, from Walter et al. 2007 and Heitz 2014.
        const double tan2_h = std::pow(std::tan(std::acos(h.z)), 2);
        const double d =
            1 / (std::numbers::pi * a * a * std::pow(h.z, 4) * std::pow(1 + tan2_h / (a * a), 2));
        const auto lambda = [&](const glm::dvec3& w) {
            const double tan2 = std::pow(std::tan(std::acos(w.z)), 2);
            return (std::sqrt(1 + a * a * tan2) - 1) / 2;
        };
        const double g = 1 / (1 + lambda(v) + lambda(l));
        const double f0 = 0.04 + (0.8 - 0.04) * s.metallic;
        const double f = f0 + (1 - f0) * std::pow(1 - glm::dot(v, h), 5);
        const double expected =
            (1 - s.metallic) * 0.8 / std::numbers::pi * (1 - f) + f * d * g / (4 * v.z * l.z);
        EXPECT_NEAR(reference_brdf(s, v, l, Shading::pbr).x, expected, 1e-9 * expected) << i;
    }
}

TEST(ReferenceBrdf, BlinnPhongMatchesThePowerOfTheCosine) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 2000; ++i) {
        const SurfaceSample s = surface(0.2 + 0.8 * unit(random), unit(random));
        const glm::dvec3 v = direction(1.5 * unit(random), 6.28 * unit(random));
        const glm::dvec3 l = direction(1.5 * unit(random), 6.28 * unit(random));
        const double n = 2 / std::pow(s.roughness, 4) - 2;
        const double f0 = 0.04 + (0.8 - 0.04) * s.metallic;
        const double expected =
            (1 - s.metallic) * 0.8 / std::numbers::pi +
            f0 * (n + 2) / (8 * std::numbers::pi) * std::pow(glm::normalize(v + l).z, n);
        EXPECT_NEAR(reference_brdf(s, v, l, Shading::blinn_phong).x, expected, 1e-9 * expected)
            << i;
    }
}

TEST(ReferenceBrdf, SpecularModelsAreReciprocal) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit;
    for (const Shading model : {Shading::blinn_phong, Shading::pbr}) {
        for (int i = 0; i < 500; ++i) {
            const SurfaceSample s = surface(unit(random), unit(random));
            const glm::dvec3 v = direction(1.4 * unit(random), 6.28 * unit(random));
            const glm::dvec3 l = direction(1.4 * unit(random), 6.28 * unit(random));
            const double forth = reference_brdf(s, v, l, model).x;
            EXPECT_NEAR(forth, reference_brdf(s, l, v, model).x, 1e-9 * forth) << i;
        }
    }
}

SurfaceSample coated(SurfaceSample s, double roughness, double coat = 1.0) {
    s.coat = coat;
    s.coat_roughness = roughness;
    s.coat_normal = kUp;
    return s;
}

// KHR_materials_clearcoat: f = mix(f_base, f_coat, clearcoat * fresnel(0.04, N.V)), in angles.
TEST(ReferenceBrdf, CoatsMixByTheEyesFresnelTerm) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 500; ++i) {
        const SurfaceSample base = surface(0.1 + 0.9 * unit(random), unit(random));
        const SurfaceSample s = coated(base, 0.1 + 0.9 * unit(random), unit(random));
        const glm::dvec3 v = direction(1.5 * unit(random), 6.28 * unit(random));
        const glm::dvec3 l = direction(1.5 * unit(random), 6.28 * unit(random));
        const double weight = s.coat * (0.04 + 0.96 * std::pow(1 - v.z, 5));
        // A white metal's lobe without Fresnel's rise is the coat's.
        SurfaceSample layer = surface(s.coat_roughness, 1.0, glm::dvec3(1.0));
        const double expected = l.z * ((1 - weight) * reference_brdf(base, v, l, Shading::pbr).x +
                                       weight * reference_brdf(layer, v, l, Shading::pbr).x);
        EXPECT_NEAR(reference_reflection(s, v, l, Shading::pbr).x, expected, 1e-9 * expected) << i;
        for (const Shading other : {Shading::lambert, Shading::blinn_phong}) {
            EXPECT_EQ(reference_reflection(s, v, l, other).x,
                      l.z * reference_brdf(base, v, l, other).x);
        }
    }
}

// White furnace: the share of light that a coat returns. Light directions are mirrored about half
// vectors drawn evenly by D, so that the sum needs few of them for a lobe of any width.
double coat_albedo(const SurfaceSample& s, const glm::dvec3& v) {
    constexpr int kRings = 2000, kColumns = 200;
    const double alpha = std::pow(std::max(s.coat_roughness, 0.045), 2);
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
        const double u = (i + 0.5) / kRings;
        const double theta = std::atan(alpha * std::sqrt(u / (1 - u)));
        const double cosine = std::cos(theta), tangent2 = std::pow(std::tan(theta), 2);
        const double d = 1 / (std::numbers::pi * alpha * alpha * std::pow(cosine, 4) *
                              std::pow(1 + tangent2 / (alpha * alpha), 2));
        for (int j = 0; j < kColumns; ++j) {
            const glm::dvec3 h = direction(theta, (j + 0.5) * 2 * std::numbers::pi / kColumns);
            const glm::dvec3 l = 2 * glm::dot(v, h) * h - v;
            if (l.z <= 0) continue;
            sum +=
                reference_reflection(s, v, l, Shading::pbr).x * 4 * glm::dot(v, h) / (d * cosine);
        }
    }
    return sum / (kRings * kColumns);
}

// Over black the coat returns its share of a lobe without Fresnel's term: all of it where the lobe
// is narrow, less where rough facets hide each other, never more.
TEST(ReferenceBrdf, CoatsReturnTheirShareOfAWhiteFurnace) {
    for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
        for (const double theta : {0.0, 0.5, 1.0, 1.3}) {
            SurfaceSample s = coated(surface(1.0, 0.0, glm::dvec3(0.0)), roughness);
            s.specular = glm::dvec3(0.0);
            s.specular_f90 = 0.0;
            const glm::dvec3 v = direction(theta, 0.3);
            const double share = reference_coat_share(s, v, Shading::pbr);
            const double albedo = coat_albedo(s, v);
            EXPECT_LE(albedo, share * (1 + 1e-3)) << roughness << ' ' << theta;
            const double least = roughness <= 0.1 ? 1 - 1e-3 : 0.3;
            EXPECT_GE(albedo, least * share) << roughness << ' ' << theta;
        }
    }
}

// Without the diffuse part: glTF's mix of it gains energy at grazing angles, as its authors state.
TEST(ReferenceBrdf, PbrLobeReflectsNoMoreThanArrives) {
    for (const double roughness : {0.2, 0.5, 1.0}) {
        for (const double theta : {0.0, 0.8, 1.3}) {
            const glm::dvec3 v = direction(theta, 0.3);
            const double metal =
                directional_albedo(surface(roughness, 1.0, {1, 1, 1}), v, Shading::pbr);
            EXPECT_LT(metal, 1.0005) << roughness << ' ' << theta;
            EXPECT_GT(metal, 0.3) << roughness << ' ' << theta;
            const double black =
                directional_albedo(surface(roughness, 0.0, {0, 0, 0}), v, Shading::pbr);
            EXPECT_LT(black, metal) << roughness << ' ' << theta;
            EXPECT_GT(black, 0.01) << roughness << ' ' << theta;
        }
    }
}

TEST(ReferenceBrdf, NarrowLobesSurviveNormalsThatAreNotQuiteUnit) {
    SurfaceSample s = surface(0.045, 1.0);
    for (const Shading model : {Shading::blinn_phong, Shading::pbr}) {
        s.normal = {0, 0, 1};
        const double exact = reference_brdf(s, kUp, kUp, model).x;
        s.normal = {0, 0, 1 + 1e-7};
        EXPECT_NEAR(reference_brdf(s, kUp, kUp, model).x, exact, 1e-6 * exact);
    }
}

TEST(ReferenceBrdf, IsFiniteWhereAnglesDegenerate) {
    for (const Shading model : {Shading::lambert, Shading::blinn_phong, Shading::pbr}) {
        for (const glm::dvec3& l : {glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0),
                                    glm::dvec3(1e-9, 0, 1), glm::dvec3(0, 0, 0.3)}) {
            for (const glm::dvec3& v : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0),
                                        glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, -1)}) {
                const glm::dvec3 f = reference_brdf(surface(0.0, 0.5), v, l, model);
                if (glm::dot(kUp, l) <= 0.0) continue;  // evaluate() never gets such light
                EXPECT_TRUE(std::isfinite(f.x) && f.x >= 0.0) << f.x;
            }
        }
    }
}

}  // namespace
}  // namespace kilolux
