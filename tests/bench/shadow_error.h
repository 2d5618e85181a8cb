// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "host/measure/bench/plot.h"
#include "host/measure/bench/table.h"
#include "host/measure/report/references.h"

namespace kilolux {

/// The error of sampled shadows with so many rays, against exact ones by the same renderer: over
/// the drawn pixels of pictures that differ in their seed.
struct SampledShadowError {
    int rays = 0;
    int seeds = 0;  // pictures
    double rmse = 0.0;
    double variance = 0.0;       // mean square of the luminance's error
    double told_variance = 0.0;  // the same as the AOV error-standard tells
    // Shares of the drawn pixels: those that some picture has otherwise than the exact one; and of
    // them those on which each half of the pictures draws kEnoughDraws hidden lights or more.
    double noisy_share = 0.0;
    double settled_share = 0.0;
    // Shares of pixels and pictures whose exact value is within the interval that is told, see
    // is_within(): of noisy pixels a picture's; of settled ones that of half of the pictures' mean.
    double within_picture = 0.0;
    double within_mean = 0.0;
};

/// From so many on their sum is about normal: 95 % intervals of a Poisson variable, estimate
/// +- 1.96 of its root, cover 93 % or more.
inline constexpr double kEnoughDraws = 25.0;

/// Whether the exact value lies within the 95 % interval about an estimate. Without a variance it
/// must be met.
bool is_within(double estimate, double variance, double exact);

/// How much is measured.
struct ShadowErrorPlan {
    std::vector<int> rays = {1, 2, 4, 8, 16, 64};
    int draws = 1024;  // seeds times rays at least
    int seeds = 16;    // at least
};

/// `settings`: one sample a pixel of them is measured, whatever their shadows. `on_step` is called
/// before every picture and may throw to stop.
std::vector<SampledShadowError> measure_shadow_error(const ReportView& view,
                                                     const RenderSettings& settings,
                                                     const ShadowErrorPlan& plan,
                                                     const std::function<void()>& on_step);

/// A row for each number of rays, and the lines that explain it.
Table shadow_error_table(const std::vector<SampledShadowError>& errors);
std::string shadow_error_notes();

/// Variance over rays, as it is and as it is told, beside a line that falls as 1/N.
Plot shadow_error_plot(const std::vector<SampledShadowError>& errors, const std::string& caption);

}  // namespace kilolux
