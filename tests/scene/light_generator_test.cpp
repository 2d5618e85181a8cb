// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_generator.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "host/base/error.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

Scene hall() {
    Scene scene;
    scene.light_box = {{-15.0, 0.2, -9.0}, {15.0, 12.0, 9.0}};
    return scene;
}

LightOptions options_for(std::uint64_t count, std::uint64_t seed = 1) {
    LightOptions options;
    options.count = count;
    options.seed = seed;
    return options;
}

std::uint64_t fingerprint(const std::vector<SceneLight>& lights) {
    std::uint64_t hash = 0;
    const auto add = [&](std::uint64_t bits) { hash = mix64(hash ^ bits) + bits; };
    for (const SceneLight& light : lights) {
        for (int i = 0; i < 3; ++i) {
            add(std::bit_cast<std::uint64_t>(light.position[i]));
            add(std::bit_cast<std::uint32_t>(light.intensity[i]));
        }
        add(std::bit_cast<std::uint32_t>(light.range));
    }
    return hash;
}

double rec709_luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// Mean over `points` of the number of lights that reach a point of the box.
double coverage(const std::vector<SceneLight>& lights, const Box& box, int points) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
        const glm::dvec3 p =
            box.min + box.size() * glm::dvec3(unit(random), unit(random), unit(random));
        for (const SceneLight& light : lights) {
            const glm::dvec3 d = light.position - p;
            sum += glm::dot(d, d) < double{light.range} * light.range ? 1.0 : 0.0;
        }
    }
    return sum / points;
}

// Mean luminance of a surface of albedo 0.5, over points of the box and random normals. Each
// point's radiance is capped at 4: a surface a hand's breadth from a lamp is overexposed anyway,
// and without a cap the mean of a d^-2 law needs very many points.
double exposure(const std::vector<SceneLight>& lights, const Box& box, int points) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
        const glm::dvec3 p =
            box.min + box.size() * glm::dvec3(unit(random), unit(random), unit(random));
        const glm::dvec3 n =
            glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        double radiance = 0.0;
        for (const SceneLight& light : lights) {
            const glm::dvec3 to_light = light.position - p;
            const double d = std::max(glm::length(to_light), 0.01);
            const double window = std::clamp(1.0 - std::pow(d / light.range, 4.0), 0.0, 1.0);
            const double cosine = std::max(glm::dot(n, to_light) / d, 0.0);
            radiance += rec709_luminance(glm::dvec3(light.intensity)) * window / (d * d) * cosine *
                        0.5 / M_PI;
        }
        sum += std::min(radiance, 4.0);
    }
    return sum / points;
}

TEST(LightGenerator, MakesTheStoredBits) {
    // Any machine, compiler, thread count and optimisation must give this number.
    EXPECT_EQ(fingerprint(generate_lights(options_for(20000), hall(), 12.5)), 2808963000004525413u);
}

TEST(LightGenerator, ThreadsAndCountChangeNoPosition) {
    const std::vector<SceneLight> few = generate_lights(options_for(100), hall(), 3.0);
    const std::vector<SceneLight> many = generate_lights(options_for(100000), hall(), 3.0);
    ASSERT_EQ(few.size(), 100u);
    ASSERT_EQ(many.size(), 100000u);
    for (std::size_t i = 0; i < few.size(); ++i) {
        EXPECT_EQ(few[i].position, many[i].position) << "light " << i;
    }
}

TEST(LightGenerator, SeedsDiffer) {
    const auto a = generate_lights(options_for(1000, 1), hall(), 0.0);
    const auto b = generate_lights(options_for(1000, 2), hall(), 0.0);
    const auto c = generate_lights(options_for(1000, 1 + (std::uint64_t{1} << 40)), hall(), 0.0);
    int same = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        same += a[i].position == b[i].position || a[i].position == c[i].position;
        same += i > 0 && a[i].position == b[i - 1].position;
    }
    EXPECT_EQ(same, 0);
}

TEST(LightGenerator, NoLightsIsEmpty) {
    EXPECT_TRUE(generate_lights(options_for(0), hall(), 0.0).empty());
    const LightScale scale = automatic_light_scale(options_for(0), hall());
    EXPECT_TRUE(std::isfinite(scale.radius) && std::isfinite(scale.intensity));
}

TEST(LightGenerator, StaysInTheBoxForever) {
    const Scene scene = hall();
    for (const double time : {0.0, 0.016, 59.9, 86400.0, 3.2e9, 1e15, -5.0, -1e9}) {
        for (const SceneLight& light : generate_lights(options_for(5000), scene, time)) {
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(light.position[axis], scene.light_box.min[axis]) << "time " << time;
                ASSERT_LE(light.position[axis], scene.light_box.max[axis]) << "time " << time;
            }
        }
    }
}

TEST(LightGenerator, FillsTheBoxEvenlyAtAnyTime) {
    const Scene scene = hall();
    for (const double time : {0.0, 777.7, 1e8}) {
        int octant[8] = {};
        for (const SceneLight& light : generate_lights(options_for(80000), scene, time)) {
            const auto above = glm::greaterThan(light.position, scene.light_box.center());
            octant[above.x + 2 * above.y + 4 * above.z]++;
        }
        // Binomial with 80000 and 1/8: standard deviation 94.
        for (const int n : octant) EXPECT_NEAR(n, 10000, 470) << "time " << time;
    }
}

TEST(LightGenerator, MovesContinuouslyAndSlowly) {
    for (const double time : {0.0, 100.0, 1e7}) {
        const auto before = generate_lights(options_for(5000), hall(), time);
        const auto after = generate_lights(options_for(5000), hall(), time + 0.01);
        double farthest = 0.0;
        double sum = 0.0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const double moved = glm::distance(before[i].position, after[i].position);
            farthest = std::max(farthest, moved);
            sum += moved;
        }
        EXPECT_LE(farthest / 0.01, 2.1) << "time " << time;  // sqrt(3) * 1.2 m/s
        EXPECT_GT(sum / 0.01 / 5000, 0.3) << "time " << time;
    }
}

TEST(LightGenerator, CoverageIsConstantOverTheCount) {
    const Scene scene = hall();
    const double at_100 =
        coverage(generate_lights(options_for(100), scene, 0), scene.light_box, 4000);
    const double at_5000 =
        coverage(generate_lights(options_for(5000), scene, 0), scene.light_box, 2000);
    const double at_1e6 =
        coverage(generate_lights(options_for(1000000), scene, 0), scene.light_box, 50);
    EXPECT_GT(at_100, 4.0);  // much of a large sphere lies outside the box
    EXPECT_NEAR(at_5000, 9.0, 1.5);
    EXPECT_NEAR(at_1e6, 10.0, 1.5);
    EXPECT_GT(coverage(generate_lights(options_for(1), scene, 0), scene.light_box, 2000), 0.5);
}

TEST(LightGenerator, ExposesWellAtAnyCount) {
    const Scene scene = hall();
    const auto at = [&](std::uint64_t count, int points) {
        return exposure(generate_lights(options_for(count), scene, 0), scene.light_box, points);
    };
    EXPECT_NEAR(at(10, 20000), 0.24, 0.08);
    EXPECT_NEAR(at(100, 20000), 0.24, 0.06);
    EXPECT_NEAR(at(5000, 4000), 0.24, 0.06);
    EXPECT_NEAR(at(1000000, 60), 0.24, 0.06);
    // One light: the mean over seeds, since one position is no sample.
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        sum += exposure(generate_lights(options_for(1, seed), scene, 0), scene.light_box, 200);
    }
    EXPECT_NEAR(sum / 200, 0.24, 0.08);
}

TEST(LightGenerator, GivenScaleIsKept) {
    LightOptions options = options_for(50);
    options.radius = 2.5;
    options.intensity = 7.0;
    for (const SceneLight& light : generate_lights(options, hall(), 0.0)) {
        EXPECT_EQ(light.range, 2.5f);
        EXPECT_NEAR(std::max({light.intensity.x, light.intensity.y, light.intensity.z}), 7.0, 1e-5);
        EXPECT_EQ(light.type, LightType::point);
    }
}

TEST(LightGenerator, ColoursAreSaturatedAndOfLikeLuminance) {
    LightOptions options = options_for(20000);
    options.intensity = 1.0;
    double sum = 0.0;
    for (const SceneLight& light : generate_lights(options, hall(), 0.0)) {
        const glm::vec3 c = light.intensity;
        EXPECT_LE(std::min({c.x, c.y, c.z}), 0.41f);
        EXPECT_GE(rec709_luminance(glm::dvec3(c)), 0.449);
        sum += rec709_luminance(glm::dvec3(c));
    }
    EXPECT_NEAR(sum / 20000, 0.633, 0.005);
}

TEST(LightGenerator, FlatAndEmptyBoxesWork) {
    LightOptions options = options_for(1000);
    options.box = {{0, 1, 0}, {10, 1, 10}};
    for (const SceneLight& light : generate_lights(options, hall(), 5.0)) {
        EXPECT_EQ(light.position.y, 1.0);
        EXPECT_GT(light.range, 0.0f);
    }
    EXPECT_NEAR(coverage(generate_lights(options, hall(), 0), options.box, 2000), 9.5, 1.5);
    options.box = {{2, 2, 2}, {2, 2, 2}};
    for (const SceneLight& light : generate_lights(options, hall(), 5.0)) {
        EXPECT_EQ(light.position, glm::dvec3(2.0));
        EXPECT_TRUE(light.range > 0.0f && std::isfinite(light.intensity.x));
    }
    options.box = {};
    EXPECT_EQ(generate_lights(options, Scene{}, 0.0).size(), 1000u);
}

TEST(LightGenerator, RefusesWhatIsNotFinite) {
    const double nan = std::nan("");
    EXPECT_THROW(generate_lights(options_for(1), hall(), nan), Error);
    LightOptions options = options_for(1);
    options.radius = -1.0;
    EXPECT_THROW(generate_lights(options, hall(), 0.0), Error);
    options = options_for(1);
    options.intensity = nan;
    EXPECT_THROW(automatic_light_scale(options, hall()), Error);
    options = options_for(1);
    options.box = {{0, 0, 0}, {1, -1, 1}};
    EXPECT_THROW(generate_lights(options, hall(), 0.0), Error);
    options.box = {{0, 0, 0}, {1, HUGE_VAL, 1}};
    EXPECT_THROW(generate_lights(options, hall(), 0.0), Error);
}

}  // namespace
}  // namespace kilolux
