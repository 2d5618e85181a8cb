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
    // One of few pixels is one of few lights, not most of them.
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

// A file of 4 x 2 equal pixels as an environment's first pixel.
template <typename Sample>
glm::vec3 read_back(const std::string& format, SampleType type, const std::array<Sample, 3>& pixel,
                    const std::vector<float>& chromaticities = {}) {
    ImageLayout layout{4, 2, {{"R", type}, {"G", type}, {"B", type}}};
    if (!chromaticities.empty()) layout.attributes.emplace_back("chromaticities", chromaticities);
    std::vector<Sample> samples;
    for (int i = 0; i < 8; ++i) samples.insert(samples.end(), pixel.begin(), pixel.end());
    const std::span<const unsigned char> bytes(
        reinterpret_cast<const unsigned char*>(samples.data()), samples.size() * sizeof(Sample));
    const TempFolder folder;
    const auto file = folder.path() / ("e." + format);
    write_file(file, encode_pixels("e", format, layout, bytes, sizeof(pixel)));
    return read_environment(file).rows[0];
}

void expect_colour(const glm::vec3& seen, const glm::vec3& wanted) {
    constexpr float kRounding = 2e-4f;  // of chromaticities in four digits
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], wanted[i], kRounding) << i;
}

TEST(Environment, FilesAreBroughtToLinearRec709) {
    using Bytes = std::array<std::uint8_t, 3>;
    using Floats = std::array<float, 3>;
    const SampleType real = SampleType::float32;
    expect_colour(read_back("png", SampleType::uint8, Bytes{128, 0, 255}), {0.2158605f, 0, 1});
    expect_colour(read_back("exr", real, Floats{0.5f, 2, 7}), {0.5f, 2, 7});
    const std::vector<float> rec2020 = {0.708f, 0.292f, 0.17f,   0.797f,
                                        0.131f, 0.046f, 0.3127f, 0.329f};
    expect_colour(read_back("exr", real, Floats{1, 1, 1}, rec2020), {1, 1, 1});
    expect_colour(read_back("exr", real, Floats{0.1f, 1, 0.1f}, rec2020), {0, 1.1196f, 0.0095f});
    const std::vector<float> acescg = {0.713f, 0.293f, 0.165f,   0.83f,
                                       0.128f, 0.044f, 0.32168f, 0.33767f};
    expect_colour(read_back("exr", real, Floats{1, 1, 1}, acescg), {1, 1, 1});
}

TEST(Environment, OddSizesAreShrunkToTheSameLight) {
    const Environment odd = painted_environment(
        513, [](const glm::dvec3& d) { return glm::dvec3(1.0 + d.x, 2.0 + d.y, 1.5 + d.z * d.x); });
    const PrefilteredEnvironment maps = prefiltered(odd);
    ASSERT_EQ(maps.levels[0].x, 1024u);
    ASSERT_EQ(maps.levels[0].y, 512u);
    const Environment even{1024, 512, {}};
    for (int y = 0; y < 512; y += 37) {
        for (int x = 0; x < 1024; x += 53) {
            const glm::dvec3 d = even.direction(x, y);
            const float* texel = &maps.texels[3 * even.place(x, y)];
            EXPECT_NEAR(texel[0], 1.0 + d.x, 1e-4);
            EXPECT_NEAR(texel[1], 2.0 + d.y, 1e-4);
            EXPECT_NEAR(texel[2], 1.5 + d.z * d.x, 1e-4);
        }
    }
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
