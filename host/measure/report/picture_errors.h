// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/measure/metrics/flip_ldr.h"
#include "host/measure/metrics/metrics.h"
#include "host/measure/reference/reference.h"
#include "host/picture/frame.h"
#include "host/render/settings.h"

namespace kilolux {

/// A float64 reference as pictures are compared with it.
struct ComparedReference {
    ReferencePicture picture;
    std::vector<std::uint8_t> display;  // its sRGB codes, 4 a pixel
};

/// With the display's codes by `settings`' exposure and tone curve.
ComparedReference compared_reference(ReferencePicture picture, const RenderSettings& settings);

/// Of FLIP's errors, 0 to 1.
struct FlipErrors {
    double mean = 0.0;
    double percentile_99_9 = 0.0;
    double max = 0.0;
};

/// Every error of one picture against one reference.
struct PictureErrors {
    HdrMetrics hdr;
    CodeDifferences codes;
    std::optional<double> ssim;  // none of pictures smaller than its window
    FlipErrors flip;             // HDR-FLIP of the linear pictures
    FlipErrors flip_display;     // LDR-FLIP of the display pictures
};

PictureErrors picture_errors(const Frame& frame, const ComparedReference& reference);

/// Magnitude of the relative error of each pixel's worst channel, |x-r| / max(|r|, E): what
/// false-colour images show.
std::vector<double> pixel_errors(const RgbImage& picture, const ReferencePicture& reference);

}  // namespace kilolux
