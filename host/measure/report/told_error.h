// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/measure/metrics/rgb_image.h"
#include "host/picture/frame.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The estimate of its own error that a picture has.
enum class ErrorTold {
    bound,     // --aov error-bound: no pixel errs more
    standard,  // --aov error-standard: the standard error of its luminance
};

/// The estimate that pictures of these settings have; none where all lights are shaded exactly.
std::optional<ErrorTold> error_told_by(const Scene& scene, const RenderSettings& settings);

/// A picture's estimated error beside its actual error [radiance]. For a bound both are medians
/// over the channels of the pixels that have one: it holds at each. For a standard error both are
/// root mean squares of the luminance over all pixels: it holds on average.
struct ToldError {
    ErrorTold kind = ErrorTold::bound;
    double told = 0.0;
    double error = 0.0;
};

/// The name of the AOV that holds the estimate.
const char* told_aov(ErrorTold kind);

/// `estimate`: that AOV of a frame of `samples` samples. Throws Error when the sizes differ.
ToldError compare_told(ErrorTold kind, const Layer& told, int samples, const RgbImage& picture,
                       const RgbImage& reference);

}  // namespace kilolux
