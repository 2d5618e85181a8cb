// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/measure/metrics/rgb_image.h"
#include "host/measure/report/mean_picture.h"
#include "host/picture/frame.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The estimate of its own error that a picture has.
enum class EstimateKind {
    bound,     // --aov error-bound: no pixel errs more
    standard,  // --aov error-standard: the standard error of its luminance
};

/// The estimate that pictures of these settings have; none where all lights are shaded exactly.
std::optional<EstimateKind> estimate_kind(const Scene& scene, const RenderSettings& settings);

/// A picture's estimated error beside its actual error [radiance]. For a bound both are medians
/// over the channels of the pixels that have one: it holds at each. For a standard error both are
/// root mean squares of the luminance over all pixels: it holds on average.
struct ErrorEstimate {
    EstimateKind kind = EstimateKind::bound;
    double estimated = 0.0;
    double error = 0.0;
    std::optional<double> within{};  // see share_within(); of sampled shadows
};

/// The name of the AOV that holds the estimate.
const char* estimate_aov(EstimateKind kind);

/// `estimate`: that AOV of a frame of `samples` samples. Throws Error when the sizes differ.
ErrorEstimate compare_estimate(EstimateKind kind, const Layer& estimate, int samples,
                               const RgbImage& picture, const RgbImage& reference);

/// Of the pixels with noise, the share whose luminance in the mean lies within the estimated 95 %
/// interval about the picture's; 1 where none has noise. `standard`: the AOV error-standard of this
/// picture of one sample. Throws Error when the sizes differ.
double share_within(const Layer& standard, const RgbImage& picture, const MeanPicture& mean);

}  // namespace kilolux
