// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/metrics/flip.h"

namespace kilolux {

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
