// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/metrics/flip_ldr.h"

namespace kilolux {

/// The exposures at which HDR-FLIP compares.
struct FlipExposures {
    double start = 0.0;  // [EV]: the brightest pixel is just not burnt out
    double stop = 0.0;   // [EV]: the median pixel is just not burnt out
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
/// Negative values count as 0, infinite ones as burnt out. Costs flip_ldr() times the number of
/// exposures. Throws Error when the sizes differ.
FlipResult flip_hdr(const RgbImage& picture, const RgbImage& reference,
                    double pixels_per_degree = kFlipPixelsPerDegree);

/// A linear picture at an exposure, tone-mapped to linear [0, 1] by the ACES fit (ibid., appendix
/// A).
RgbImage flip_tone_map(const RgbImage& image, double exposure_ev);

}  // namespace kilolux
