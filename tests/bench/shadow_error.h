// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "host/measure/bench/plot.h"
#include "host/measure/bench/table.h"
#include "host/measure/report/references.h"

namespace kilolux {

/// The error of sampled shadows with so many rays, against exact ones by the same renderer, or
/// where lights have a size the mean of many pictures: over the pixels with a surface, of pictures
/// that differ in their seed.
struct SampledShadowError {
    int rays = 0;
    int seeds = 0;  // pictures
    double rmse = 0.0;
    double variance = 0.0;            // mean square of the luminance's error
    double estimated_variance = 0.0;  // the same, estimated by the AOV error-standard
    // Shares of the pixels with a surface: those on which some picture differs from the exact one;
    // and of them those on which each half of the pictures draws kEnoughDraws hidden lights or
    // more.
    double noisy_share = 0.0;
    double tested_share = 0.0;
    // Shares of pixels and pictures whose exact value is within the estimated interval, see
    // is_within(): for noisy pixels the interval of a picture; for tested ones that of the mean of
    // half of the pictures.
    double within_picture = 0.0;
    double within_mean = 0.0;
};

/// With at least so many draws their sum is about normal: 95 % intervals of a Poisson variable,
/// estimate +- 1.96 of its root, cover 93 % or more.
inline constexpr double kEnoughDraws = 25.0;

/// The extent of the measurement.
struct ShadowErrorPlan {
    std::vector<int> rays = {1, 2, 4, 8, 16, 64};
    int draws = 1024;                             // seeds times rays at least
    int seeds = 16;                               // at least
    MeanPlan truth{.rays = 64, .pictures = 128};  // with lights that have a size
};

/// Measures one sample a pixel of `settings`, with sampled shadows. `on_step` is called before
/// every picture and may throw to stop.
std::vector<SampledShadowError> measure_shadow_error(const ReportView& view,
                                                     const RenderSettings& settings,
                                                     const ShadowErrorPlan& plan,
                                                     const std::function<void()>& on_step);

/// A row for each number of rays, and the lines that explain it.
Table shadow_error_table(const std::vector<SampledShadowError>& errors);
std::string shadow_error_notes();

/// Variance over rays, actual and estimated, beside a line that falls as 1/N.
Plot shadow_error_plot(const std::vector<SampledShadowError>& errors, const std::string& caption);

}  // namespace kilolux
