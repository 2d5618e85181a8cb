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

/// Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images", section 4.1:
/// the tone curve maps the reference's largest luminance (start) and its median (stop) to 0.85.
/// When half the picture or more is black, the median is that of the other pixels; an all-black
/// reference gives 0 to 0 EV. Values that are not finite are left out.
FlipExposures flip_exposures(const RgbImage& reference);

/// HDR-FLIP of two linear Rec. 709 pictures (ibid.): for every pixel the largest LDR-FLIP of the
/// tone-mapped pictures over flip_exposures().
///
/// Negative values count as 0, infinite ones as white. Costs flip_ldr() times the number of
/// exposures. Throws Error when the sizes differ.
FlipResult flip_hdr(const RgbImage& picture, const RgbImage& reference,
                    double pixels_per_degree = kFlipPixelsPerDegree);

/// A linear picture at an exposure, tone-mapped to linear [0, 1] by the ACES fit (ibid., appendix
/// A).
RgbImage flip_tone_map(const RgbImage& image, double exposure_ev);

}  // namespace kilolux
