// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/picture_errors.h"

#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/metrics/ssim.h"
#include "host/measure/report/display.h"

namespace kilolux {
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
