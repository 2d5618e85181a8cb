// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/picture_errors.h"

#include <algorithm>
#include <cmath>

#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/metrics/ssim.h"
#include "host/measure/report/display.h"

namespace kilolux {
namespace {

FlipErrors flip_errors(const FlipResult& flip) {
    return {flip.error.mean, flip.error.percentile_99_9, flip.error.max};
}

}  // namespace

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
    out.flip = flip_errors(flip_hdr(picture, r.radiance).flip);
    out.flip_display =
        flip_errors(flip_ldr(linear_from_display(shown), linear_from_display(wanted)));
    return out;
}

std::vector<double> pixel_errors(const RgbImage& picture, const ReferencePicture& reference) {
    std::vector<double> out(picture.pixel_count(), 0.0);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        const double x = picture.rgb[i];
        const double r = reference.radiance.rgb[i];
        const double unit = std::max(std::abs(r), reference.scale.rgb[i]);
        const double error = x == r ? 0.0 : std::abs(x - r) / unit;
        double& worst = out[i / 3];
        if (!(error <= worst)) worst = error;  // NaN stays
    }
    return out;
}

}  // namespace kilolux
