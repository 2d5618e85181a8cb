// SPDX-License-Identifier: Apache-2.0
// Display codes against double: exact rounding to sRGB, tone curves, and light with NaN.
#include "host/stages/picture/tonemap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/certify/synthetic/random.h"
#include "host/certify/synthetic/run_probe.h"
#include "kernels/shared/tone_curve.h"
#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// IEC 61966-2-1, rounded to the nearest code.
int code_of(long double linear) {
    const long double v = std::clamp(linear, 0.0L, 1.0L);
    const long double encoded =
        v <= 0.0031308L ? 12.92L * v : 1.055L * std::pow(v, 1 / 2.4L) - 0.055L;
    return static_cast<int>(std::lround(255 * encoded));
}

struct Colors {
    std::vector<float> red, green, blue;

    void add(float r, float g, float b) {
        red.push_back(r);
        green.push_back(g);
        blue.push_back(b);
    }
    glm::dvec3 at(std::size_t i) const { return {red[i], green[i], blue[i]}; }
};

// An image of one row of the necessary width.
std::vector<uint> display_of(int lanes, int curve, const Colors& colors, float exposure_ev = 0.0f) {
    const Gpu gpu = test_gpu(lanes);
    View view{};
    view.width = static_cast<uint>(colors.red.size());
    view.height = 1;
    view.stride = static_cast<uint>(round_up(colors.red.size(), 16));
    std::vector<float> planes;
    for (const auto* channel : {&colors.red, &colors.green, &colors.blue}) {
        planes.insert(planes.end(), channel->begin(), channel->end());
        planes.resize(round_up(planes.size(), view.stride), 0.5f);
    }
    Tonemap stage(gpu, default_tuning(gpu.info), curve);
    StageTimer timer;
    return download<uint>(gpu, stage.enqueue({new_buffer(gpu, planes), view}, exposure_ev, timer),
                          view.width);
}

int channel(uint display, int index) { return static_cast<int>(display >> (8 * index) & 255u); }

// Every boundary between two codes and the floats beside it; each value comes in all three
// channels.
std::vector<float> boundary_values() {
    std::vector<float> values = {0.0f,   -0.0f, 1.0f,   0.5f,   2.0f,     1e30f,
                                 -1e-6f, -1.0f, -1e30f, 1e-40f, 0x1p-13f, 0x1p-14f};
    for (int code = 0; code < 255; ++code) {
        const long double v = (code + 0.5L) / 255;
        const long double linear =
            v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L);
        float f = static_cast<float>(linear);
        for (int i = 0; i < 3; ++i) f = std::nextafter(f, -kInfinity);
        for (int i = 0; i < 7; ++i, f = std::nextafter(f, kInfinity)) values.push_back(f);
    }
    Random random(1);
    for (int i = 0; i < 20000; ++i)
        values.push_back(static_cast<float>(random.log_uniform(1e-5, 1.2)));
    return values;
}

TEST(Tonemap, RoundsToTheNearestCodeAtEveryBoundary) {
    const std::vector<float> values = boundary_values();
    for (const int lanes : lane_widths()) {
        for (const float ev : {0.0f, 3.0f, -5.0f}) {
            Colors colors;
            const std::size_t n = values.size();
            for (std::size_t i = 0; i < n; ++i) {
                colors.add(std::ldexp(values[i], static_cast<int>(-ev)),
                           std::ldexp(values[(i + 1) % n], static_cast<int>(-ev)),
                           std::ldexp(values[(i + 2) % n], static_cast<int>(-ev)));
            }
            const auto display = display_of(lanes, TONE_CURVE_NONE, colors, ev);
            for (std::size_t i = 0; i < n; ++i) {
                ASSERT_EQ(display[i] >> 24, 255u);
                for (int c = 0; c < 3; ++c) {
                    const float value = values[(i + static_cast<std::size_t>(c)) % n];
                    ASSERT_EQ(channel(display[i], c), code_of(value))
                        << "linear " << std::hexfloat << value << ", channel " << c;
                }
            }
        }
    }
}

// Khronos PBR Neutral Tone Mapper specification.
glm::dvec3 neutral(glm::dvec3 c) {
    const double x = std::min({c.x, c.y, c.z});
    const double offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
    c = c - glm::dvec3{offset, offset, offset};
    const double peak = std::max({c.x, c.y, c.z});
    const double start = 0.8 - 0.04;
    if (peak < start) return c;
    const double d = 1 - start;
    const double new_peak = 1 - d * d / (peak + d - start);
    const double g = 1 - 1 / (0.15 * (peak - new_peak) + 1);
    return c * (new_peak / peak) * (1 - g) + glm::dvec3{1, 1, 1} * (new_peak * g);
}

// S. Hill's fit of the ACES reference rendering and sRGB output transforms.
glm::dvec3 aces(glm::dvec3 c) {
    const auto fit = [](double v) {
        return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    };
    const double r = fit(0.59719 * c.x + 0.35458 * c.y + 0.04823 * c.z);
    const double g = fit(0.07600 * c.x + 0.90834 * c.y + 0.01566 * c.z);
    const double b = fit(0.02840 * c.x + 0.13383 * c.y + 0.83777 * c.z);
    return {1.60475 * r - 0.53108 * g - 0.07367 * b, -0.10208 * r + 1.10813 * g - 0.00605 * b,
            -0.00327 * r - 0.07276 * g + 1.07602 * b};
}

// B. Wrensch's fit of AgX, base look, to linear light by the exponent 2.2.
glm::dvec3 agx(glm::dvec3 c) {
    const auto curve = [](double v) {
        const double x = (std::clamp(std::log2(v), -12.47393, 4.026069) + 12.47393) / 16.499999;
        return 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) -
               6.868 * std::pow(x, 3) + 0.4298 * x * x + 0.1191 * x - 0.00232;
    };
    const auto linear = [](double v) { return std::pow(std::clamp(v, 0.0, 1.0), 2.2); };
    const double r = curve(0.842479062253094 * c.x + 0.0784336 * c.y + 0.0792237451477643 * c.z);
    const double g =
        curve(0.0423282422610123 * c.x + 0.878468636469772 * c.y + 0.0791661274605434 * c.z);
    const double b = curve(0.0423756549057051 * c.x + 0.0784336 * c.y + 0.879142973793104 * c.z);
    return {linear(1.19687900512017 * r - 0.0980208811401368 * g - 0.0990297440797205 * b),
            linear(-0.0528968517574562 * r + 1.15190312990417 * g - 0.0989611768448433 * b),
            linear(-0.0529716355144438 * r - 0.0980434501171241 * g + 1.15107367264116 * b)};
}

glm::dvec3 in_double(int curve, glm::dvec3 c) {
    if (curve == TONE_CURVE_NEUTRAL) return neutral(c);
    return curve == TONE_CURVE_ACES ? aces(c) : agx(c);
}

TEST(Tonemap, CurvesAgreeWithDouble) {
    Random random(2);
    Colors colors;
    for (int i = 0; i < 20000; ++i) {
        const double size = random.log_uniform(1e-4, 1e4);
        colors.add(static_cast<float>(size * random.unit()),
                   static_cast<float>(size * random.unit()),
                   static_cast<float>(size * random.unit()));
    }
    for (const auto& [lanes, curve] :
         {std::pair(1, TONE_CURVE_NEUTRAL), std::pair(1, TONE_CURVE_ACES),
          std::pair(1, TONE_CURVE_AGX), std::pair(0, TONE_CURVE_NEUTRAL),
          std::pair(0, TONE_CURVE_ACES), std::pair(0, TONE_CURVE_AGX)}) {
        const auto display = display_of(lanes, curve, colors);
        int different = 0;
        for (std::size_t i = 0; i < display.size(); ++i) {
            const glm::dvec3 expected = in_double(curve, colors.at(i));
            const double values[] = {expected.x, expected.y, expected.z};
            for (int c = 0; c < 3; ++c) {
                const int off = std::abs(channel(display[i], c) - code_of(values[c]));
                ASSERT_LE(off, 1) << "curve " << curve << ", color " << i << " (" << colors.red[i]
                                  << ", " << colors.green[i] << ", " << colors.blue[i]
                                  << "), channel " << c << ": " << channel(display[i], c)
                                  << ", expected " << code_of(values[c]);
                different += off;
            }
        }
        // Only where rounding of the curve meets a boundary.
        EXPECT_LE(different, 30) << "curve " << curve;
    }
}

TEST(Tonemap, NotANumberAndNegativeAreBlackAndInfiniteIsWhite) {
    for (const int lanes : lane_widths()) {
        for (const int curve :
             {TONE_CURVE_NONE, TONE_CURVE_NEUTRAL, TONE_CURVE_ACES, TONE_CURVE_AGX}) {
            SCOPED_TRACE("lanes " + std::to_string(lanes) + ", curve " + std::to_string(curve));
            Colors colors;
            for (const float v : {kNan, -kNan, -1.0f, -1e30f, -kInfinity}) colors.add(v, v, v);
            for (const float v : {kInfinity, 1e30f}) colors.add(v, v, v);
            const auto display = display_of(lanes, curve, colors);
            for (int i = 0; i < 5; ++i)
                EXPECT_EQ(display[static_cast<std::size_t>(i)], 0xff000000u) << "color " << i;
            for (int i = 5; i < 7; ++i)
                EXPECT_EQ(display[static_cast<std::size_t>(i)], 0xffffffffu) << "color " << i;
        }
    }
}

constexpr std::string_view kToneCurve[] = {"kernels/device/lanes.h", "kernels/shared/tone_curve.h"};
constexpr std::string_view kBackdropProbe = R"(
kernel void probe(global const float* in, global int* out) {
    size_t i = get_global_id(0);
    float3 c = vload3(2 * i, in), backdrop = vload3(2 * i + 1, in);
    FV3 light = fv3(fv(c.x), fv(c.y), fv(c.z));
    MASK same = is_backdrop(light, fv3(fv(backdrop.x), fv(backdrop.y), fv(backdrop.z)));
    out[i] = lane_any(same) ? 1 : 0;
}
)";

// Light that differs from the backdrop in one channel alone is none; a few roundings are.
TEST(Tonemap, ABackdropIsToldFromLightByEveryChannel) {
    const std::array<float, 3> backdrop = {0.3f, 0.5f, 0.2f};
    std::vector<float> in;
    std::vector<int> expected;
    for (const float times : {1.0f, 1.0f + 3e-7f, 1.01f, kNan}) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            std::array<float, 3> light = backdrop;
            light[channel] *= times;
            in.insert(in.end(), light.begin(), light.end());
            in.insert(in.end(), backdrop.begin(), backdrop.end());
            expected.push_back(times < 1.001f ? 1 : 0);
        }
    }
    const std::size_t count = expected.size();
    EXPECT_EQ(at_every_width([&](const Gpu& gpu) {
                  return run_probe<int>(gpu, {kToneCurve, kBackdropProbe}, count, count, in);
              }),
              expected);
}

TEST(Tonemap, ImagesOfAnySize) {
    for (const std::size_t pixels : {1u, 15u, 16u, 17u, 4099u}) {
        Colors colors;
        for (std::size_t i = 0; i < pixels; ++i)
            colors.add(static_cast<float>(i % 256) / 255.0f, 0.25f, 0.0f);
        const auto display = display_of(0, TONE_CURVE_NONE, colors);
        for (std::size_t i = 0; i < pixels; ++i)
            ASSERT_EQ(channel(display[i], 0), code_of(colors.red[i]));
    }
}

}  // namespace
}  // namespace kilolux
