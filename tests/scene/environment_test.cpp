// SPDX-License-Identifier: Apache-2.0
// An environment as directional lights: its power, and a Lambert sphere's error over their number.
#include "host/scene/lights/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/base/error.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

// A blue sky over brown ground, with a small warm sun.
Environment sky(int width = 128) {
    Environment e{width, width / 2, {}};
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.5, 0.7, -0.4));
    for (int y = 0; y < e.height; ++y) {
        for (int x = 0; x < e.width; ++x) {
            const glm::dvec3 d = e.direction(x, y);
            glm::dvec3 c =
                d.y > 0.0 ? glm::dvec3(0.3, 0.5, 0.9) * (1.2 - d.y) : glm::dvec3(0.25, 0.2, 0.15);
            c += 60.0 * std::exp(200.0 * (glm::dot(d, sun) - 1.0)) * glm::dvec3(1.0, 0.9, 0.7);
            e.rows.emplace_back(c);
        }
    }
    return e;
}

// Irradiance of a surface with this normal, by all pixels, and by lights.
glm::dvec3 irradiance(const Environment& e, const glm::dvec3& normal) {
    glm::dvec3 sum(0.0);
    for (int y = 0; y < e.height; ++y) {
        for (int x = 0; x < e.width; ++x) {
            sum += e.light(x, y) * std::max(glm::dot(normal, e.direction(x, y)), 0.0);
        }
    }
    return sum;
}

glm::dvec3 irradiance(const std::vector<SceneLight>& lights, const glm::dvec3& normal) {
    glm::dvec3 sum(0.0);
    for (const SceneLight& light : lights) {
        sum += glm::dvec3(light.intensity) * std::max(-glm::dot(normal, light.direction), 0.0);
    }
    return sum;
}

// Root mean square over a Lambert sphere of the error, relative to the mean.
double sphere_error(const Environment& e, const std::vector<SceneLight>& lights) {
    double error2 = 0.0, mean = 0.0;
    constexpr int kNormals = 200;
    for (int i = 0; i < kNormals; ++i) {
        const double y = (2.0 * i + 1.0) / kNormals - 1.0, r = std::sqrt(1.0 - y * y);
        const glm::dvec3 n(r * std::cos(2.4 * i), y, r * std::sin(2.4 * i));
        const glm::dvec3 wanted = irradiance(e, n);
        const glm::dvec3 off = irradiance(lights, n) - wanted;
        error2 += glm::dot(off, off) / kNormals;
        mean += glm::length(wanted) / kNormals;
    }
    return std::sqrt(error2) / mean;
}

TEST(Environment, PixelsCoverTheSphere) {
    const Environment e = sky(32);
    double all = 0.0;
    for (int y = 0; y < e.height; ++y) all += e.width * e.solid_angle(y);
    EXPECT_NEAR(all, 4.0 * std::numbers::pi, 1e-12);
    EXPECT_GT(e.direction(3, 0).y, 0.99);
    EXPECT_LT(e.direction(16, 8).z, -0.98) << "the middle is ahead";
    EXPECT_GT(e.direction(24, 8).x, 0.98) << "right of it is +X";
}

TEST(Environment, LightsHaveItsPower) {
    const Environment e = sky();
    glm::dvec3 wanted(0.0);
    for (int y = 0; y < e.height; ++y) {
        for (int x = 0; x < e.width; ++x) wanted += e.light(x, y);
    }
    for (const std::size_t count : {1u, 2u, 7u, 64u, 1000u}) {
        const auto lights = environment_lights(e, count);
        EXPECT_EQ(lights.size(), count);
        glm::dvec3 sum(0.0);
        for (const SceneLight& light : lights) sum += glm::dvec3(light.intensity);
        // Each light is rounded to a float once.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / wanted[c], 1.0, 1e-7) << count;
    }
}

TEST(Environment, TheErrorOfALambertSphereFallsWithTheNumber) {
    const Environment e = sky();
    double last = sphere_error(e, environment_lights(e, 4));
    EXPECT_LT(last, 0.5);
    for (const std::size_t count : {16u, 64u, 256u}) {
        const double error = sphere_error(e, environment_lights(e, count));
        EXPECT_LT(error, 0.6 * last) << count;
        last = error;
    }
    EXPECT_LT(last, 0.005);
}

TEST(Environment, LightInOnePixelIsOneLight) {
    Environment e{8, 4, std::vector<glm::vec3>(32, glm::vec3(0.0f))};
    EXPECT_TRUE(environment_lights(e, 5).empty());
    e.rows[13] = {1.0f, 2.0f, 3.0f};
    const auto lights = environment_lights(e, 5);
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_LT(glm::length(lights[0].direction + e.direction(5, 1)), 1e-12);
}

TEST(Environment, BrokenFilesAreOneLine) {
    const TempFolder folder;
    const auto file = folder.path() / "a.hdr";
    EXPECT_TRUE(contains(message_of<Error>([&] { read_environment(file); }), "a.hdr"));
    write_file(file, std::string("no picture"));
    EXPECT_TRUE(contains(message_of<Error>([&] { read_environment(file); }), "a.hdr"));
    write_file(file, encode_image("hdr", 3, 3, Blob(27, 128)));
    EXPECT_TRUE(
        contains(message_of<Error>([&] { read_environment(file); }), "is twice as wide as high"));
}

}  // namespace
}  // namespace kilolux
