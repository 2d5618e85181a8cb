// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/measure/metrics/flip_ldr.h"

namespace kilolux {

enum class FlipToneMapper { aces, hable, reinhard };

struct FlipHdrOptions {
    double pixels_per_degree = flip_pixels_per_degree();
    FlipToneMapper tone_mapper = FlipToneMapper::aces;
    std::optional<double>
        start_exposure{};                   // [EV]; empty: from the reference, see flip_exposures()
    std::optional<double> stop_exposure{};  // [EV]
    int exposure_count = 0;                 // at least 2; 0: one an EV
};

/// The exposures that HDR-FLIP looks at.
struct FlipExposures {
    double start = 0.0;  // [EV]: the brightest pixel just not burnt out
    double stop = 0.0;   // [EV]: neither is the median pixel
    int count = 2;
};

/// Those of Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images",
/// section 4.1, unless `options` name others: from the largest and the median luminance of the
/// reference that the tone mapper maps to 0.85. When half the picture or more is black, the median
/// of the rest counts; an all-black reference gets 0 to 0 EV. Values that are not finite are left
/// out. Throws Error when start is above stop.
FlipExposures flip_exposures(const RgbImage& reference, const FlipHdrOptions& options = {});

struct FlipHdrResult {
    FlipResult flip;          // of every pixel, its largest error over the exposures
    FlipExposures exposures;  // that were looked at
};

/// HDR-FLIP of two linear Rec. 709 pictures (ibid.): LDR-FLIP of both tone-mapped at each exposure.
///
/// Negative values count as 0 and infinite ones as burnt out. Costs flip_ldr() times the number of
/// exposures. Throws Error when the sizes differ.
FlipHdrResult flip_hdr(const RgbImage& picture, const RgbImage& reference,
                       const FlipHdrOptions& options = {});

/// A linear HDR picture at an exposure, tone-mapped to [0, 1] linear (ibid., appendix A).
RgbImage flip_tone_map(const RgbImage& image, double exposure_ev, FlipToneMapper tone_mapper);

}  // namespace kilolux
