// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/measure/metrics/error_metrics.h"
#include "host/measure/reference/reference.h"
#include "host/picture/frame.h"
#include "host/render/settings.h"

namespace kilolux {

/// The sRGB codes, 4 per pixel, opaque, that the renderer would show for a linear picture without
/// bloom: exposure, tone curve, IEC 61966-2-1 rounded to the nearest code.
std::vector<std::uint8_t> display_codes(const RgbImage& image, float exposure_ev, ToneCurve curve);

/// A float64 reference, linear and as displayed.
struct ComparedReference {
    ReferencePicture picture;
    std::vector<std::uint8_t> display;  // its sRGB codes, 4 a pixel
};

/// Displayed with `settings`' exposure and tone curve.
ComparedReference compared_reference(ReferencePicture picture, const RenderSettings& settings);

/// Every error of a frame.
PictureErrors picture_errors(const Frame& frame, const ComparedReference& reference);

}  // namespace kilolux
