// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <vector>

#include "host/measure/metrics/metrics.h"
#include "host/measure/metrics/rgb_image.h"

namespace kilolux {

/// Pixels of the display per degree of visual angle: the FLIP papers' observer, 0.7 m away from a
/// 0.7 m wide display of 3840 pixels.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840.0 / 0.7) * (std::numbers::pi / 180.0);

/// For every pixel, how visible the difference is when two pictures alternate.
struct FlipResult {
    int width = 0;               // [pixel]
    int height = 0;              // [pixel]
    std::vector<double> errors;  // width * height, 0 (equal) .. 1, row 0 on top
    ErrorDistribution error;     // of `errors`; channel is 0
};

/// LDR-FLIP of two linear Rec. 709 pictures with values in [0, 1], others are clamped; symmetric.
///
/// Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images". A pixel with a NaN
/// in one picture only has the error 1. Runs on all cores: about a second for
/// 1920x1080 on two. Throws Error when the sizes differ.
FlipResult flip_ldr(const RgbImage& picture, const RgbImage& reference,
                    double pixels_per_degree = kFlipPixelsPerDegree);

/// The exposures at which HDR-FLIP compares.
struct FlipExposures {
    double start = 0.0;  // [EV]: the brightest pixel is just below white
    double stop = 0.0;   // [EV]: the median pixel is just below white
    int count = 2;       // one per EV, at least 2
};

}  // namespace kilolux
