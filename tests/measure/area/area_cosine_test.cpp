// SPDX-License-Identifier: Apache-2.0
// The irradiance of area lights: the shared text against float64 integrals.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <iostream>
#include <utility>

#include "tests/measure/area/area_cases.h"

namespace kilolux {
namespace {

constexpr double kPi = std::numbers::pi;

AreaShape flat(AreaKind kind, glm::dvec3 center, glm::dvec3 x, glm::dvec3 y) {
    return {kind, center, x, y, 0.0, false};
}

AreaShape sphere(glm::dvec3 center, double radius) {
    return {AreaKind::sphere, center, glm::dvec3(0.0), glm::dvec3(0.0), radius, false};
}

struct Worst {
    double error = -1.0;
    AreaShape shape{};
    void take(double e, const AreaShape& s) {
        if (!(e <= error)) *this = {e, s};
    }
};

// Cases of each distance; KILOLUX_AREA_CASES for longer runs.
int cases() {
    const char* given = std::getenv("KILOLUX_AREA_CASES");
    return given ? std::atoi(given) : 25;
}

TEST(AreaCosine, EqualsTheIntegralAtAnyDistance) {
    AreaRandom random(7);
    constexpr std::array<double, 8> kDistances{1e-4, 1e-2, 0.3, 1.0, 3.0, 30.0, 1e3, 1e5};
    for (const AreaKind kind :
         {AreaKind::rectangle, AreaKind::disk, AreaKind::sphere, AreaKind::triangle})
        for (std::size_t band = 1; band < kDistances.size(); ++band) {
            Worst worst;
            for (int i = 0; i < cases(); ++i) {
                const double distance = random.log_uniform(kDistances[band - 1], kDistances[band]);
                const double aspect = i % 2 == 0 ? 1.0 : random.log_uniform(0.1, 1.0);
                const AreaShape s = random_shape(kind, distance, aspect, random);
                worst.take(cosine_error(s, random), s);
            }
            std::cout << "kind " << static_cast<int>(kind) << " to " << kDistances[band]
                      << " sizes: " << worst.error << '\n';
            EXPECT_LT(worst.error, 2e-5) << worst.shape << " gives " << shared_cosine(worst.shape)
                                         << " not " << reference_cosine(worst.shape, kUp).value;
        }
}

// The largest lights that few samples integrate, and the nearest whose edges' terms cancel.
TEST(AreaCosine, EqualsTheIntegralWhereFormsMeet) {
    AreaRandom random(17);
    for (const AreaKind kind : {AreaKind::rectangle, AreaKind::disk, AreaKind::triangle}) {
        Worst worst;
        for (int i = 0; i < 12 * cases(); ++i) {
            const float small = kind == AreaKind::triangle ? SMALL_TRIANGLE : SMALL_LIGHT;
            const float limit = std::array{DISTANT_LIGHT, DISTANT_CUT_LIGHT, small}[i % 3];
            AreaShape s = random_shape(kind, 1.0, random.log_uniform(0.2, 1.0), random);
            const double square = glm::dot(s.half_x, s.half_x) + glm::dot(s.half_y, s.half_y);
            const double share = i % 2 == 0 ? 1.001 : 0.999;
            s.center *= std::sqrt(square / (limit * share) / glm::dot(s.center, s.center));
            s = stored(s);
            worst.take(cosine_error(s, random), s);
        }
        std::cout << "kind " << static_cast<int>(kind) << ": " << worst.error << '\n';
        EXPECT_LT(worst.error, 1e-5) << worst.shape;
    }
}

// Rounding of edges' directions is not relative to the width: the error grows with the aspect.
TEST(AreaCosineHard, ErrorIsARoundingOfTheLongerSide) {
    AreaRandom random(3);
    for (const AreaKind kind : {AreaKind::rectangle, AreaKind::disk, AreaKind::triangle}) {
        Worst worst;
        for (int i = 0; i < 10 * cases(); ++i) {
            const double aspect = random.log_uniform(1e-12, 0.1);
            const AreaShape s = random_shape(kind, random.log_uniform(0.3, 1e4), aspect, random);
            worst.take(cosine_error(s, random) / std::max(1.0, 0.01 / aspect), s);
        }
        std::cout << "kind " << static_cast<int>(kind) << ": " << worst.error << '\n';
        EXPECT_LT(worst.error, 1e-4) << worst.shape;
    }
}

TEST(AreaCosineKnown, SquaresThatFaceEachOther) {
    constexpr int kSteps = 300;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
            sum += shared_cosine(flat(AreaKind::rectangle,
                                      {(i + 0.5) / kSteps - 0.5, (k + 0.5) / kSteps - 0.5, 1.0},
                                      {0.5, 0, 0}, {0, -0.5, 0}));
    EXPECT_NEAR(sum / (kSteps * kSteps * kPi), 0.199825, 6e-7);
}

TEST(AreaCosineKnown, DiskOnItsAxisAndSphere) {
    for (const double d : {1e-3, 0.1, 1.0, 7.0, 300.0}) {
        const AreaShape disk = flat(AreaKind::disk, {0, 0, d}, {2, 0, 0}, {0, -2, 0});
        const double want = kPi * 4.0 / (4.0 + d * d);
        EXPECT_NEAR(shared_cosine(disk), want, 2e-6 * want) << d;
        EXPECT_NEAR(reference_cosine(disk, kUp).value, want, 1e-9 * want) << d;
        const AreaShape ball = sphere({0, 0, 2.0 + d}, 2.0);
        const double seen = kPi * 4.0 / ((2.0 + d) * (2.0 + d));
        EXPECT_NEAR(shared_cosine(ball), seen, 2e-6 * seen) << d;
        EXPECT_NEAR(reference_cosine(ball, kUp).value, seen, 1e-9 * seen) << d;
    }
}

TEST(AreaReference, SolidAnglesAndErrors) {
    const auto one = [](const glm::dvec3&) { return glm::dvec3(1.0); };
    const AreaIntegral octant = integrate_area(
        flat(AreaKind::triangle, glm::dvec3(1.0 / 3.0), {-1, 0, 1}, {-1, 1, 0}), one);
    EXPECT_NEAR(octant.value.x, kPi / 2.0, octant.error + 1e-12);
    const AreaIntegral ball = integrate_area(sphere({0, 3, 0}, 1.5), kUp, one);
    EXPECT_NEAR(ball.value.x, kPi * (1.0 - std::sqrt(0.75)), ball.error + 1e-12);
    // A wall that ends in the surface fills half of what it shines to.
    const AreaCosine wall =
        reference_cosine(flat(AreaKind::rectangle, {0, 1e-3, 0}, {1e6, 0, 0}, {0, 0, 1e6}), kUp);
    EXPECT_NEAR(wall.value, kPi / 2.0, 1e-8);
    EXPECT_LT(wall.error, 1e-8);
}

TEST(AreaCosineSides, NothingBehindBelowOrInside) {
    for (const AreaKind kind : {AreaKind::rectangle, AreaKind::disk, AreaKind::triangle})
        for (const double d : {1e-3, 0.5, 5.0, 500.0}) {
            EXPECT_EQ(shared_cosine(flat(kind, {0.1, 0.2, d}, {1, 0, 0}, {0, 1, 0})), 0.0);
            EXPECT_EQ(shared_cosine(flat(kind, {0.1, 0.2, -d}, {1, 0, 0}, {0, 1, 0})), 0.0);
            EXPECT_GT(shared_cosine(flat(kind, {0.1, 0.2, d}, {1, 0, 0}, {0, -1, 0})), 0.0);
            // Behind and across the horizon.
            EXPECT_LT(shared_cosine(flat(kind, {0, d, 0}, {0, 0, 1}, {1, 0, 0})),
                      shared_cosine(flat(kind, {0, d, 0}, {1, 0, 0}, {0, 0, 1})) * 1e-5 + 1e-9);
        }
    EXPECT_EQ(sphere_irradiance(fv3(0.5f, 0, 0), 1.0f), 0.0f);
    EXPECT_EQ(sphere_irradiance(fv3(0, 0, 1.0f), 1.0f), 0.0f);
    EXPECT_EQ(sphere_irradiance(fv3(0, 0, -1.5f), 1.0f), 0.0f);
}

TEST(AreaCosineSides, ADiskFillsASpheresSolidAngle) {
    AreaRandom random(5);
    for (int i = 0; i < 500; ++i) {
        const double distance = 1.0 + random.log_uniform(1e-3, 1e4);
        const FV3 center = float3_of(random.direction() * distance);
        const FlatLight disk = sphere_disk(center, 1.0f);
        EXPECT_NEAR(disk_irradiance(disk.center, disk.half_x, disk.half_y, false),
                    facing_disk_irradiance(disk.center, disk.half_x), 2e-4 / (distance * distance))
            << distance << ' ' << center.x << ' ' << center.y << ' ' << center.z;
    }
}

// Coordinates of every magnitude, equal, opposite or 0: on edges, at corners, in the light's plane,
// edges seen end-on, lights without area.
TEST(AreaCosineHard, IsAlwaysANumberFromZeroToPi) {
    AreaRandom random(11);
    const auto coordinate = [&] {
        static const std::array<double, 12> kValues{0.0,   1.0,   -1.0, 0.5,   -0.5, 1e-45,
                                                    1e-39, 1e-20, 1e-6, -1e-6, 1e4,  1e9};
        return kValues[static_cast<std::size_t>(random.uniform(0.0, 11.999))];
    };
    const auto vector = [&] { return glm::dvec3(coordinate(), coordinate(), coordinate()); };
    for (int i = 0; i < 400'000; ++i) {
        AreaShape s{
            static_cast<AreaKind>(i % 4), vector(), vector(), vector(), coordinate(), false};
        s.radius = std::abs(s.radius);
        const double value = shared_cosine(s);
        ASSERT_TRUE(value >= 0.0 && value <= 3.1415928) << s << " gives " << value;
    }
}

// Points near the light's plane: before the light, at its edges and corners, and beyond them.
TEST(AreaCosineHard, EqualsTheIntegralNearTheLightsPlane) {
    AreaRandom random(13);
    Worst worst;
    for (const AreaKind kind : {AreaKind::rectangle, AreaKind::disk, AreaKind::triangle})
        for (const double u : {0.0, 0.9999, 1.0, 1.0001, 3.0})
            for (const double v : {0.0, 0.5, 1.0})
                for (const double height : {1e-5, 1e-3, 0.1}) {
                    const glm::dvec3 a = random.direction();
                    const glm::dvec3 b = glm::normalize(glm::cross(a, random.direction()));
                    const AreaShape s =
                        stored(flat(kind, a * u + b * v + glm::cross(a, b) * height, a, b));
                    worst.take(cosine_error(s, random), s);
                }
    std::cout << worst.error << '\n';
    EXPECT_LT(worst.error, 2e-5) << worst.shape;
}

// The largest second difference of `value_at` over equal steps from 0 to 1, relative to `unit`.
template <typename F>
double largest_step(const F& value_at, int steps, double unit) {
    double largest = 0.0, before = value_at(0.0), last = value_at(1.0 / steps);
    for (int i = 2; i <= steps; ++i) {
        const double value = value_at(static_cast<double>(i) / steps);
        largest = std::max(largest, std::abs(value - 2.0 * last + before) / unit);
        before = std::exchange(last, value);
    }
    return largest;
}

// Also where another form takes over.
TEST(AreaCosineHard, IsContinuous) {
    for (const AreaKind kind : {AreaKind::rectangle, AreaKind::disk, AreaKind::triangle})
        for (const double aspect : {1.0, 0.1, 0.03}) {
            const auto away = [&](double t) {
                const double d = 0.5 * std::pow(200.0, t);
                return d * d *
                       shared_cosine(flat(kind, glm::dvec3(0.1, 0.3, 1.0) * d, {1, 0, 0},
                                          {0, -aspect, 0.3 * aspect}));
            };
            EXPECT_LT(largest_step(away, 10'000, aspect), 3e-4) << static_cast<int>(kind);
            for (const double d : {0.7, 2.0, 3.0, 10.0, 30.0}) {
                const auto up = [&](double t) {
                    return d * d *
                           shared_cosine(flat(kind, {0.3, d, 1.5 * (2.0 * t - 1.0)}, {1, 0, 0},
                                              {0.1, 0, aspect}));
                };
                EXPECT_LT(largest_step(up, 10'000, aspect), 3e-4) << static_cast<int>(kind) << d;
            }
        }
}

}  // namespace
}  // namespace kilolux
