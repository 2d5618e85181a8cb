// SPDX-License-Identifier: Apache-2.0
#include "present/image/automatic_exposure.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kilolux {
namespace {

// The upper bits of a positive float that count light: its exponent and 12 bits of its mantissa.
constexpr unsigned kDropped = 11;
constexpr std::size_t kBins = std::size_t{1} << (31 - kDropped);

std::size_t bin_of(float light) { return std::bit_cast<std::uint32_t>(light) >> kDropped; }

}  // namespace

ExposureMeter::ExposureMeter() : brightest_(kBins) {}

void ExposureMeter::add(std::span<const float> radiance) {
    for (std::size_t i = 0; i + 2 < radiance.size(); i += 3) {
        const double luminance =
            0.2126 * radiance[i] + 0.7152 * radiance[i + 1] + 0.0722 * radiance[i + 2];
        if (!(luminance > 0.0) || !std::isfinite(luminance)) continue;
        log_sum_ += std::log2(luminance);
        ++count_;
        const float most = std::max({radiance[i], radiance[i + 1], radiance[i + 2]});
        Bin& bin = brightest_[bin_of(most)];
        ++bin.pixels;
        bin.most = std::max(bin.most, most);
    }
}

float ExposureMeter::exposure() const {
    constexpr double kMiddleGrey = 0.18;
    constexpr double kDisplayWhite = 1.0;
    constexpr double kClippedShare = 0.02;  // of the lit pixels, at most
    constexpr double kMost = 126.0;         // [EV] that a float holds
    if (count_ == 0) return 0.0f;
    const auto count = static_cast<double>(count_);
    const auto unclipped = static_cast<std::uint64_t>(std::ceil((1.0 - kClippedShare) * count));
    std::size_t bin = 0;
    for (std::uint64_t below = brightest_[0].pixels; below < unclipped;)
        below += brightest_[++bin].pixels;
    const double mean_ev = std::round(100.0 * (std::log2(kMiddleGrey) - log_sum_ / count));
    const double most_ev = std::floor(100.0 * std::log2(kDisplayWhite / brightest_[bin].most));
    return static_cast<float>(std::clamp(0.01 * std::min(mean_ev, most_ev), -kMost, kMost));
}

float automatic_exposure(std::span<const float> radiance) {
    ExposureMeter meter;
    meter.add(radiance);
    return meter.exposure();
}

}  // namespace kilolux
