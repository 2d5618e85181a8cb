// SPDX-License-Identifier: Apache-2.0
// An environment as directional lights: its power, and a Lambert sphere's error over their number.
#include "host/scene/lights/environment.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "host/base/error.h"
#include "host/images/images.h"
#include "host/scene/lights/built_in_environments.h"
#include "host/scene/lights/prefiltered_environment.h"
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

TEST(Environment, LightsHaveItsPowerAndAxes) {
    // 2^-53 of the part of a side that is perpendicular, which may be 1e-6 long.
    constexpr double kRoundedSide = 1e-9;
    const Environment e = sky();
    glm::dvec3 wanted(0.0);
    for (int y = 0; y < e.height; ++y) {
        for (int x = 0; x < e.width; ++x) wanted += e.light(x, y);
    }
    for (const std::size_t count : {1u, 2u, 7u, 64u, 1000u}) {
        const auto lights = environment_lights(e, count);
        EXPECT_EQ(lights.size(), count);
        glm::dvec3 sum(0.0);
        for (const SceneLight& light : lights) {
            sum += glm::dvec3(light.intensity);
            EXPECT_NEAR(glm::dot(light.direction, light.side), 0.0, kRoundedSide);
        }
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

double luminance(const glm::dvec3& c) { return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722)); }

TEST(BuiltInEnvironment, TheSkyIsBlueItsSunWarmAndBothAsBrightAsSaid) {
    const Environment e = environment_of("sky");
    ASSERT_EQ(e.width, 2 * e.height);
    EXPECT_EQ(e.rows, sky_environment().rows);
    double brightest = 0.0;
    glm::dvec3 sun(0.0), sky(0.0), towards(0.0);
    for (int y = 0; y < e.height / 2; ++y) {
        for (int x = 0; x < e.width; ++x) {
            const glm::dvec3 light = e.light(x, y);
            const glm::vec3 c = e.rows[static_cast<std::size_t>(y * e.width + x)];
            ASSERT_TRUE(std::isfinite(c.x + c.y + c.z) && std::min({c.x, c.y, c.z}) >= 0.0f);
            const bool is_sun = c.y > 20.0f;
            (is_sun ? sun : sky) += is_sun ? light : light * e.direction(x, y).y;
            if (c.y > brightest) towards = e.direction(x, y);
            brightest = std::max(brightest, double{c.y});
        }
    }
    EXPECT_NEAR(luminance(sky), 1.0, 0.03);
    EXPECT_NEAR(luminance(sun), 3.0, 0.03);
    EXPECT_GT(sky.z, 1.3 * sky.x);
    EXPECT_GT(sun.x, 1.2 * sun.z);
    EXPECT_NEAR(std::asin(towards.y) * 180.0 / std::numbers::pi, 40.0, 0.3);
    EXPECT_GT(towards.z, 0.3) << "ahead of the front of an object";
    // With few pixels the sun is few lights, not most of them.
    int narrow = 0;
    for (const SceneLight& light : environment_lights(e, 128)) {
        narrow += glm::dot(-light.direction, towards) > std::cos(0.02) ? 1 : 0;
    }
    EXPECT_GE(narrow, 1);
    EXPECT_LE(narrow, 24);
}

TEST(BuiltInEnvironment, TheStudioLightsTheFrontMost) {
    const Environment e = environment_of("studio");
    const auto from = [&](const glm::dvec3& normal) { return luminance(irradiance(e, normal)); };
    const double front = from({0, 0, 1});
    // A face of albedo 0.5 has a radiance of 0.3 to 0.5, as in the studio of lights.
    EXPECT_GT(0.5 * front / std::numbers::pi, 0.3);
    EXPECT_LT(0.5 * front / std::numbers::pi, 0.5);
    for (const glm::dvec3& other :
         {glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0)}) {
        EXPECT_GT(front, 1.2 * from(other));
        EXPECT_GT(from(other), 0.15 * front) << "no side is black";
    }
    EXPECT_GT(from({-1, 0, 0}), from({1, 0, 0})) << "the key is on the left";
}

TEST(Environment, AnyHeightIsShrunkWithItsPower) {
    for (const int width : {1024, 1030, 514, 2050}) {
        const Environment whole = sky(width);
        const Environment small = shrunk(whole, 128);
        EXPECT_LE(small.width, 128) << width;
        EXPECT_EQ(small.width, 2 * small.height) << width;
        for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0, -0.8)}) {
            const glm::dvec3 wanted = irradiance(whole, normal);
            EXPECT_LT(glm::length(irradiance(small, normal) - wanted), 3e-3 * glm::length(wanted))
                << width;
        }
    }
}

TEST(Environment, FilesOfIntegersAreEncodedAndPrimariesAreKept) {
    const TempFolder folder;
    write_file(folder.path() / "a.png", encode_image("png", 2, 3, {188, 0, 255, 188, 0, 255}));
    const glm::vec3 c = read_environment(folder.path() / "a.png").rows.at(0);
    EXPECT_NEAR(c.x, 0.5029, 1e-4);
    EXPECT_EQ(c.y, 0.0f);
    EXPECT_EQ(c.z, 1.0f);
    ImageLayout deep{
        2, 1, {{"R", SampleType::uint16}, {"G", SampleType::uint16}, {"B", SampleType::uint16}}};
    const std::vector<std::uint16_t> grey(6, 32896);
    write_file(folder.path() / "deep.png",
               encode_pixels("deep", "png", deep, bytes_of(grey), 3 * sizeof(std::uint16_t)));
    EXPECT_NEAR(read_environment(folder.path() / "deep.png").rows.at(0).y, 0.2159, 1e-4);
    // ACES 2065-1: its white stays white, and its middle green is brighter in Rec. 709.
    ImageLayout layout{
        2, 1, {{"R", SampleType::float32}, {"G", SampleType::float32}, {"B", SampleType::float32}}};
    layout.attributes.emplace_back(
        "chromaticities",
        std::vector<float>{0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f});
    const std::vector<float> pixels = {0.5f, 0.5f, 0.5f, 0.2f, 0.4f, 0.2f};
    write_file(folder.path() / "a.exr",
               encode_pixels("a", "openexr", layout, bytes_of(pixels), 3 * sizeof(float)));
    const Environment e = read_environment(folder.path() / "a.exr");
    for (glm::length_t i = 0; i < 3; ++i) EXPECT_NEAR(e.rows.at(0)[i], 0.5f, 1e-4f);
    EXPECT_GT(e.rows.at(1).y, 0.42f);
    EXPECT_LT(e.rows.at(1).x, 0.15f);
}

// OpenImageIO leaves these lines of the header to its caller.
TEST(Environment, TheHeaderOfARadianceFileCounts) {
    const TempFolder folder;
    const auto file = folder.path() / "a.hdr";
    const auto first = [&](const std::string& lines, const std::string& rgbe) {
        write_file(file,
                   "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n-Y 1 +X 2\n" + rgbe + rgbe);
        return read_environment(file).rows.at(0);
    };
    const std::string grey = "\x40\x40\x40\x81", green = "\x20\x40\x20\x81";
    EXPECT_NEAR(first("", grey).x, 0.5f, 4e-3f);
    const float plain = first("", grey).x;
    EXPECT_FLOAT_EQ(first("EXPOSURE=2.0\n", grey).x, plain / 2.0f);
    EXPECT_FLOAT_EQ(first("EXPOSURE= 2\nEXPOSURE=3\n", grey).x, plain / 6.0f);
    EXPECT_FLOAT_EQ(first("COLORCORR= 2 1 4\n", grey).z, plain / 4.0f);
    const std::string aces = "PRIMARIES= 0.7347 0.2653 0.0 1.0 0.0001 -0.077 0.32168 0.33767\n";
    EXPECT_NEAR(first(aces, grey).x, plain, 1e-4f);
    EXPECT_GT(first(aces, green).y, 1.05f * first("", green).y);
    EXPECT_TRUE(contains(message_of<Error>([&] { first("EXPOSURE=0\n", grey); }),
                         "a.hdr: EXPOSURE is 0, must be > 0"));
    EXPECT_TRUE(contains(message_of<Error>([&] { first("PRIMARIES= 1 2\n", grey); }),
                         "a.hdr: PRIMARIES is ' 1 2', must be 8 numbers"));
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

// Before memory is taken for what a header claims.
TEST(Environment, NeedsNoMoreMemoryThanThereMayBe) {
    const TempFolder folder;
    const auto file = folder.path() / "a.hdr";
    write_file(file, std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32000 +X 64000\n"));
    EXPECT_TRUE(contains(message_of<Error>([&] { read_environment(file, 1 << 30); }),
                         "a.hdr: needs 39063 MiB of memory as an environment, 1024 MiB of 1024 MiB "
                         "are left (--max-memory)"))
        << message_of<Error>([&] { read_environment(file, 1 << 30); });
}

}  // namespace
}  // namespace kilolux
