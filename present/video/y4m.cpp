// SPDX-License-Identifier: Apache-2.0
#include "present/video/y4m.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "host/base/hash.h"

namespace kilolux {
namespace {

// Shares of R', G' and B' in BT.709's luma.
constexpr double kRed = 0.2126, kGreen = 0.7152, kBlue = 0.0722;

// Steps of a code of limited range for a step of a display code.
constexpr double kLumaStep = 219.0 / 255.0;
constexpr double kBlueStep = 224.0 / 255.0 / (2.0 * (1.0 - kBlue));
constexpr double kRedStep = 224.0 / 255.0 / (2.0 * (1.0 - kRed));

// The nearest code. Vector instructions convert doubles to int only.
inline char nearest(double code) {
    return static_cast<char>(static_cast<unsigned char>(static_cast<int>(code + 0.5)));
}

// A PlaneMaker. It is inlined, and so compiled for the instructions of its caller.
[[gnu::always_inline]] inline void put_planes(const std::uint8_t* __restrict rgba,
                                              std::size_t pixels, char* __restrict luma) {
    char* __restrict const blue = luma + pixels;
    char* __restrict const red = blue + pixels;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double r = rgba[4 * i], g = rgba[4 * i + 1], b = rgba[4 * i + 2];
        const double y = kRed * r + kGreen * g + kBlue * b;
        luma[i] = nearest(16.0 + kLumaStep * y);
        blue[i] = nearest(128.0 + kBlueStep * (b - y));
        red[i] = nearest(128.0 + kRedStep * (r - y));
    }
}

void put_planes_anywhere(const std::uint8_t* rgba, std::size_t pixels, char* planes) {
    put_planes(rgba, pixels, planes);
}

#if defined(__x86_64__)
// Not of "fma", whose multiply-adds round once: other bits.
[[gnu::target("avx2")]] void put_planes_by_avx2(const std::uint8_t* rgba, std::size_t pixels,
                                                char* planes) {
    put_planes(rgba, pixels, planes);
}
#endif

}  // namespace

// By the convergents of the continued fraction, the nearest ratios for their terms.
Ratio ratio_of(double value) {
    constexpr double kMost = 2147483647.0;
    double before[2] = {0.0, 1.0}, now[2] = {1.0, 0.0};
    double rest = value;
    for (int i = 0; i < 64; ++i) {
        const double whole = std::floor(rest);
        const double next[2] = {whole * now[0] + before[0], whole * now[1] + before[1]};
        if (next[0] > kMost || next[1] > kMost) break;
        for (int k = 0; k < 2; ++k) {
            before[k] = now[k];
            now[k] = next[k];
        }
        if (std::abs(now[0] / now[1] - value) <= 1e-9 * value || rest == whole) break;
        rest = 1.0 / (rest - whole);
    }
    if (now[0] < 1.0) return {1, static_cast<std::uint32_t>(kMost)};
    return {static_cast<std::uint32_t>(now[0]), static_cast<std::uint32_t>(now[1])};
}

std::string y4m_header(const VideoFormat& format, const std::string& note) {
    const Ratio pace = ratio_of(format.frames_per_second);
    const std::string hash =
        note.empty() ? "" : fmt::format(" X{:08x}", static_cast<std::uint32_t>(hash64(note)));
    return fmt::format(
        "YUV4MPEG2 W{} H{} F{}:{} Ip A1:1 C444 XCOLORRANGE=LIMITED XMATRIX=BT709{}\n", format.width,
        format.height, pace.numerator, pace.denominator, hash);
}

std::span<const PlaneMaker> plane_makers() {
#if defined(__x86_64__)
    static constexpr PlaneMaker kMakers[] = {put_planes_anywhere, put_planes_by_avx2};
    return std::span(kMakers).first(__builtin_cpu_supports("avx2") ? 2 : 1);
#else
    static constexpr PlaneMaker kMakers[] = {put_planes_anywhere};
    return kMakers;
#endif
}

void y4m_frame(std::span<const std::uint8_t> rgba, std::string& out) {
    constexpr std::string_view kHead = "FRAME\n";
    const std::size_t pixels = rgba.size() / 4;
    out.resize(kHead.size() + 3 * pixels);
    std::ranges::copy(kHead, out.begin());
    plane_makers().back()(rgba.data(), pixels, &out[kHead.size()]);
}

}  // namespace kilolux
