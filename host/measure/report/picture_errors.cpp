// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/picture_errors.h"

#include <algorithm>
#include <cmath>

#include "host/base/formats/srgb.h"
#include "host/measure/metrics/flip.h"
#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/metrics/ssim.h"
#include "kernels/shared/tone_curve.h"

namespace kilolux {
namespace {

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
            tone_curve_of(static_cast<int>(curve), fv3(displayable(image.rgb[i] * gain),
                                                       displayable(image.rgb[i + 1] * gain),
                                                       displayable(image.rgb[i + 2] * gain)));
        out.insert(out.end(), {srgb_code(c.x), srgb_code(c.y), srgb_code(c.z), 255});
    }
    return out;
}

ComparedReference compared_reference(ReferencePicture picture, const RenderSettings& settings) {
    auto display = display_codes(picture.radiance, settings.exposure, settings.tone_curve);
    return {std::move(picture), std::move(display)};
}

PictureErrors picture_errors(const Frame& frame, const ComparedReference& reference) {
    const RgbImage picture = rgb_image_of(frame.width, frame.height, frame.radiance);
    const ReferencePicture& r = reference.picture;
    const DisplayView shown{frame.width, frame.height, frame.display};
    const DisplayView wanted{r.radiance.width, r.radiance.height, reference.display};
    PictureErrors out;
    out.hdr = compare_hdr(picture, r.radiance, {.scale = &r.scale});
    out.codes = compare_codes(shown, wanted);
    out.ssim = ssim(shown, wanted);
    out.flip = flip_hdr(picture, r.radiance).error;
    out.flip_display = flip_ldr(linear_from_display(shown), linear_from_display(wanted)).error;
    return out;
}

}  // namespace kilolux
