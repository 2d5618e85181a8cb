// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/measure/metrics/metrics.h"
#include "host/measure/metrics/rgb_image.h"

namespace kilolux {

/// Where an observer sits: pixels of the display per degree of visual angle.
///
/// The default is that of the FLIP papers: 0.7 m away from a 0.7 m wide display of 3840
/// pixels, 67.02.
double flip_pixels_per_degree(double distance_m = 0.7, double display_width_px = 3840.0,
                              double display_width_m = 0.7);

/// What an observer notices when two pictures alternate, for every pixel.
struct FlipResult {
    int width = 0;               // [pixel]
    int height = 0;              // [pixel]
    std::vector<double> errors;  // width * height, 0 (equal) .. 1, row 0 on top
    ErrorDistribution error;     // of `errors`; channel is 0
};

/// LDR-FLIP of two linear Rec. 709 pictures with values in [0, 1], others are clamped; symmetric.
///
/// Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images". A pixel with a NaN
/// in either picture and not the other has the error 1. Runs on all cores: about a second for
/// 1920x1080 on two. Throws Error when the sizes differ.
FlipResult flip_ldr(const RgbImage& picture, const RgbImage& reference,
                    double pixels_per_degree = flip_pixels_per_degree());

}  // namespace kilolux
