// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/display.h"

#include <algorithm>
#include <cmath>

#include "host/base/srgb.h"
#include "kernels/shared/tone_curve.h"

namespace kilolux {
namespace {

FV3 toned(FV3 color, ToneCurve curve) {
    switch (curve) {
        case ToneCurve::neutral:
            return neutral_tone_curve(color);
        case ToneCurve::aces:
            return aces_tone_curve(color);
        case ToneCurve::none:
            break;
    }
    return color;
}

std::uint8_t srgb_code(double linear) {
    return static_cast<std::uint8_t>(
        std::lround(linear_to_srgb(std::clamp(linear, 0.0, 1.0)) * 255.0));
}

}  // namespace

std::vector<std::uint8_t> display_codes(const RgbImage& image, float exposure_ev, ToneCurve curve) {
    const double gain = std::exp2(static_cast<double>(exposure_ev));
    std::vector<std::uint8_t> out;
    out.reserve(4 * image.pixel_count());
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        const FV3 c =
            toned(fv3(displayable(image.rgb[i] * gain), displayable(image.rgb[i + 1] * gain),
                      displayable(image.rgb[i + 2] * gain)),
                  curve);
        out.insert(out.end(), {srgb_code(c.x), srgb_code(c.y), srgb_code(c.z), 255});
    }
    return out;
}

}  // namespace kilolux
