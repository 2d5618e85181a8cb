// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/measure/metrics/rgb_image.h"
#include "host/render/settings.h"

namespace kilolux {

/// The sRGB codes, 4 per pixel, opaque, that the renderer would show for a linear picture without
/// bloom: exposure, tone curve, IEC 61966-2-1 rounded to the nearest code.
std::vector<std::uint8_t> display_codes(const RgbImage& image, float exposure_ev, ToneCurve curve);

}  // namespace kilolux
