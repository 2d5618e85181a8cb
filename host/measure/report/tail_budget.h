// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "host/measure/report/references.h"

namespace kilolux {

/// Settings whose bound of the light that ranges take is within a budget.
struct TailChoice {
    RenderSettings settings;  // those asked for, with other tails
    double bound = 0.0;       // largest of any pixel and colour: radiance
};

/// The metric of --error-metric that tails_within() serves.
inline constexpr const char* kBoundMetric = "bound";

/// The largest range budget, of 1/4, 1/8 ... 2^-20, with which no pixel of this view lacks more
/// than `max_bound` of radiance; where none is small enough, exact tails, which lack nothing. The
/// picture is made at the size asked for, so this is a guarantee, not an estimate, for this view.
/// Calls `step` before each picture and passes its exceptions on.
TailChoice tails_within(const ReportView& view, const RenderSettings& asked, double max_bound,
                        const std::function<void()>& step);

}  // namespace kilolux
