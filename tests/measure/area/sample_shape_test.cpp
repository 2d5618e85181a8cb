// SPDX-License-Identifier: Apache-2.0
// Random points of area lights: their densities against references in double.
#include "kernels/shared/area/sample_shape.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "host/measure/reference/area/area_light.h"

namespace kilolux {
namespace {

struct Case {
    AreaShape shape;
    glm::dvec3 normal;  // of the surface
};

FV3 lanes_of(const glm::dvec3& v) {
    return fv3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

uint kind_of(AreaKind kind) {
    constexpr std::array kKinds = {SHAPE_RECTANGLE, SHAPE_DISK, SHAPE_SPHERE, SHAPE_TRIANGLE};
    return kKinds[static_cast<std::size_t>(kind)];
}

SampledShape seen(const Case& of) {
    const bool is_sphere = of.shape.kind == AreaKind::sphere;
    return see_shape(kind_of(of.shape.kind), lanes_of(of.shape.center),
                     lanes_of(is_sphere ? glm::dvec3(of.shape.radius, 0, 0) : of.shape.half_x),
                     lanes_of(of.shape.half_y), lanes_of(of.normal));
}

// A shape of random form and place, its centre as far away as `distance` sizes. Both sides shine.
Case random_case(std::mt19937& random, AreaKind kind, double distance) {
    std::normal_distribution<double> normal;
    const auto direction = [&] {
        return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    };
    Case out;
    out.shape.kind = kind;
    out.shape.two_sided = true;
    out.shape.center = glm::dvec3(glm::vec3(distance * direction()));
    out.shape.half_x = glm::dvec3(glm::vec3(direction()));
    out.shape.half_y = glm::dvec3(glm::vec3(0.5 * direction()));
    out.shape.radius = kind == AreaKind::sphere ? 1.0 : 0.0;
    out.normal = direction();
    return out;
}

constexpr std::array kKinds = {AreaKind::rectangle, AreaKind::disk, AreaKind::sphere,
                               AreaKind::triangle};

// The mean of `value` over an even grid of random numbers.
template <typename Value>
double mean_of(int steps, const Value& value) {
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const auto u = static_cast<float>((i + 0.5) / steps);
            const auto v = static_cast<float>((j + 0.5) / steps);
            sum += value(u, v);
        }
    }
    return sum / (steps * steps);
}

glm::dvec3 direction_of(const ShapeSample& s) {
    return glm::normalize(glm::dvec3(s.to_light.x, s.to_light.y, s.to_light.z));
}

// With samples even in solid angle, the kept share times the bound of cosines times the solid angle
// is the irradiance: of the whole light, and of halves of it.
TEST(SampleShape, KeepsADensityOfTheCosine) {
    std::mt19937 random(5);
    for (const AreaKind kind : kKinds) {
        for (const double distance : {1.2, 3.0, 100.0}) {
            for (int i = 0; i < 8; ++i) {
                const Case c = random_case(random, kind, distance);
                const SampledShape s = seen(c);
                const glm::dvec3 center = glm::normalize(c.shape.center);
                const glm::dvec3 across = glm::normalize(glm::cross(center, c.shape.half_x));
                const double solid =
                    integrate_area(
                        c.shape, [](const glm::dvec3&) { return glm::dvec3(1.0); }, 1e-6)
                        .value.x;
                const double all = reference_cosine(c.shape, c.normal).value;
                const double part = integrate_area(
                                        c.shape, c.normal,
                                        [&](const glm::dvec3& to) {
                                            const double side =
                                                glm::dot(to, across) > 0.0 ? 1.0 : 0.0;
                                            return glm::dvec3(side * glm::dot(to, c.normal));
                                        },
                                        1e-4)
                                        .value.x;
                const double weight = std::max(double{s.most}, 0.0) * s.solid_angle;
                const double kept = mean_of(
                    200, [&](float u, float v) { return double{sample_shape(s, u, v).share}; });
                const double half = mean_of(200, [&](float u, float v) {
                    const ShapeSample at = sample_shape(s, u, v);
                    return glm::dot(direction_of(at), across) > 0.0 ? double{at.share} : 0.0;
                });
                EXPECT_NEAR(weight * kept, all, 2e-3 * solid)
                    << static_cast<int>(kind) << " at " << distance << " case " << i;
                EXPECT_NEAR(weight * half, part, 1e-2 * solid)
                    << static_cast<int>(kind) << " at " << distance << " case " << i;
            }
        }
    }
}

// Even in solid angle: counts in cells of equal random numbers would be even whatever the map, so
// cells are those of direction. Chi-square of 40,000 samples with 15 degrees of freedom.
TEST(SampleShape, IsEvenInSolidAngle) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const auto below_one = [&] { return std::min(unit(random), 0x1.fffffep-1f); };
    for (const AreaKind kind : {AreaKind::rectangle, AreaKind::sphere, AreaKind::triangle}) {
        const Case c = random_case(random, kind, 1.3);
        const SampledShape s = seen(c);
        const glm::dvec3 middle = glm::normalize(c.shape.center);
        const glm::dvec3 x = glm::normalize(glm::cross(middle, glm::dvec3(0.3, 0.5, 0.8)));
        const glm::dvec3 y = glm::cross(middle, x);
        const auto cell_of = [&](const glm::dvec3& to) {
            const double turn = std::atan2(glm::dot(to, x), glm::dot(to, y)) + 3.14159265358979;
            return static_cast<std::size_t>(std::min(15.0, turn / 6.28318530717959 * 16.0));
        };
        std::array<double, 16> expected{}, found{};
        double all = 0.0;
        for (std::size_t cell = 0; cell < 16; ++cell) {
            expected[cell] = integrate_area(
                                 c.shape,
                                 [&](const glm::dvec3& to) {
                                     return glm::dvec3(cell_of(to) == cell ? 1.0 : 0.0);
                                 },
                                 1e-4)
                                 .value.x;
            all += expected[cell];
        }
        constexpr int kSamples = 40000;
        for (int i = 0; i < kSamples; ++i) {
            const float u = below_one(), v = below_one();
            ++found[cell_of(direction_of(sample_shape(s, u, v)))];
        }
        double square = 0.0;
        for (std::size_t cell = 0; cell < 16; ++cell) {
            const double mean = kSamples * expected[cell] / all;
            if (mean < 1.0) continue;
            square += std::pow(found[cell] - mean, 2.0) / mean;
        }
        EXPECT_LT(square, 37.7) << static_cast<int>(kind) << ": 1 in 1000 is larger";
    }
}

// Far, narrow and degenerate lights: samples are finite and lie on the light.
TEST(SampleShape, LiesOnTheLight) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0.0f, 0.999999f);
    for (const AreaKind kind : kKinds) {
        for (const double distance : {1.1, 1e2, 1e4, 1e6}) {
            for (int i = 0; i < 200; ++i) {
                Case c = random_case(random, kind, distance);
                if (i % 4 == 1) c.shape.half_y *= 1e-6;
                if (i % 4 == 2) c.shape.half_y = c.shape.half_x;  // no area
                const ShapeSample s = sample_shape(seen(c), unit(random), unit(random));
                const glm::dvec3 at(s.to_light.x, s.to_light.y, s.to_light.z);
                ASSERT_TRUE(std::isfinite(at.x + at.y + at.z + s.share))
                    << static_cast<int>(kind) << " at " << distance << " case " << i;
                ASSERT_GE(s.share, 0.0f);
                ASSERT_LE(s.share, 1.0f);
                const double off = glm::length(at - c.shape.center);
                if (i % 4 == 2) continue;
                // Rounding of the point's vector moves it along a plane seen edge-on.
                EXPECT_LT(off, 2.1 + 3e-5 * distance)
                    << static_cast<int>(kind) << " at " << distance << " case " << i;
            }
        }
    }
}

// A point inside a sphere sees none of it; a light below the horizon keeps no sample.
TEST(SampleShape, OfWhatIsNotSeenKeepsNothing) {
    Case inside;
    inside.shape.kind = AreaKind::sphere;
    inside.shape.radius = 2.0;
    inside.shape.center = {0.5, 1.0, 0.0};
    inside.normal = {0.0, 1.0, 0.0};
    EXPECT_EQ(seen(inside).solid_angle, 0.0f);
    Case below;
    below.shape.center = {0.0, -3.0, 0.0};
    below.shape.half_x = {1.0, 0.0, 0.0};
    below.shape.half_y = {0.0, 0.0, 1.0};
    below.normal = {0.0, 1.0, 0.0};
    const SampledShape s = seen(below);
    EXPECT_EQ(mean_of(20, [&](float u, float v) { return double{sample_shape(s, u, v).share}; }),
              0.0);
}

}  // namespace
}  // namespace kilolux
