// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/measure/metrics/rgb_image.h"
#include "host/picture/frame.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// What a picture tells of its own error.
enum class ErrorTold {
    bound,     // --aov error-bound: no pixel errs more
    standard,  // --aov error-standard: the standard error of its luminance
};

/// What pictures of these settings tell; nothing where all lights are shaded as they are.
std::optional<ErrorTold> error_told_by(const Scene& scene, const RenderSettings& settings);

/// A picture's own word on its error beside the error [radiance]. For a bound both are medians over
/// the channels of the pixels that have one: it holds at each. For a standard error both are root
/// mean squares of the luminance over all pixels: it holds on average.
struct ToldError {
    ErrorTold kind = ErrorTold::bound;
    double told = 0.0;
    double error = 0.0;
};

/// The name of the AOV that tells it.
const char* told_aov(ErrorTold kind);

/// `told`: that AOV of a frame of `samples` samples. Throws Error when the sizes differ.
ToldError compare_told(ErrorTold kind, const Layer& told, int samples, const RgbImage& picture,
                       const RgbImage& reference);

}  // namespace kilolux
