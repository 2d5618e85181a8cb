// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/measure/metrics/rgb_image.h"

namespace kilolux {

/// How errors are distributed over the values of a picture, and where the worst is.
struct ErrorDistribution {
    double mean = 0.0;
    double percentile_99_9 = 0.0;  // nearest rank: 99.9 % of the values are not larger
    double max = 0.0;
    int x = 0;  // of the first value that equals max [pixel], row 0 on top
    int y = 0;
    int channel = 0;  // 0..channels-1: R, G, B
};

/// Of `errors`: `channels` values a pixel, interleaved, `width` pixels a row. None may be NaN.
ErrorDistribution error_distribution(std::span<const double> errors, int width, int channels);

/// "59,126": the place of the worst value, column and row from the upper left pixel 0,0.
std::string pixel_text(const ErrorDistribution& worst);

/// Errors of a linear HDR picture against a reference, over all channels of all pixels.
///
/// A value that is not finite and differs from the reference's has the error infinity, so that it
/// shows in every mean and maximum and fails every threshold.
struct HdrMetrics {
    ErrorDistribution absolute;  // |x - r|
    ErrorDistribution relative;  // |x - r| / max(|r|, E); 0 where x = r
    double rmse = 0.0;
    double psnr_peak = 0.0;  // that psnr_db refers to
    double psnr_db = 0.0;    // 20 log10(peak / rmse); infinite when equal
    double rel_mse = 0.0;    // mean of (x-r)^2 / (r^2 + eps), eps = 1e-2 * mean(r)^2
    std::uint64_t pixels = 0;
    std::uint64_t nan_pixels = 0;        // with a NaN in the picture
    std::uint64_t infinite_pixels = 0;   // with +-Inf in the picture
    std::uint64_t negative_pixels = 0;   // with a value below 0 in the picture; -0 is not
    std::uint64_t different_pixels = 0;  // whose float32 bits differ from the reference's
};

struct HdrOptions {
    const RgbImage* scale = nullptr;  // E = sum |I att| of the lights, see reference.h; null: 0
    double psnr_peak = 0.0;           // 0: the largest finite value of the reference
};

/// Compares `picture` with `reference` in double. Throws Error when the sizes differ.
HdrMetrics compare_hdr(const RgbImage& picture, const RgbImage& reference,
                       const HdrOptions& options = {});

/// The error of each pixel's worst channel: |x - r|, or with `scale` |x - r| / max(|r|, E). NaN
/// stays NaN. For heat maps.
std::vector<double> pixel_errors(const RgbImage& picture, const RgbImage& reference,
                                 const RgbImage* scale = nullptr);

/// Differences of 8-bit codes of two display-referred pictures.
struct CodeDifferences {
    ErrorDistribution difference;  // |a - b| in codes
    std::uint64_t pixels = 0;
    std::uint64_t different_pixels = 0;  // by one code or more
};

/// Compares R, G and B of two display pictures. Throws Error when the sizes differ.
CodeDifferences compare_codes(const DisplayView& picture, const DisplayView& reference);

}  // namespace kilolux
