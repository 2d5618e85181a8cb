// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/measure/metrics/rgb_image.h"
#include "host/render/settings.h"

namespace kilolux {

/// sRGB codes, 4 a pixel, opaque, of a linear picture as the renderer shows it without bloom:
/// exposure, tone curve, and IEC 61966-2-1 rounded to the nearest code. NaN and negative light are
/// black.
std::vector<std::uint8_t> display_codes(const RgbImage& image, float exposure_ev, ToneCurve curve);

}  // namespace kilolux
