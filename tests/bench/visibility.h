// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/measure/bench/lighting_bench.h"
#include "host/measure/bench/table.h"
#include "host/measure/roofline/stage_report.h"

namespace kilolux {

/// A way to find which pixels see which lights of their lists: cast_shadows alone.
struct VisibilityMeasurement : StageEffort {
    std::string walks;   // "shafts", or "bundles of 16 rays"
    double ms = 0.0;     // least
    double times = 1.0;  // of the time of shafts
    ShadowCounts counts{};
};

/// Times a walk for each (active cluster, light) pair, and a walk for each vector of pixels and
/// light, as `deferred-all` does it: on one G-buffer with the same lists, in turns. Throws Error
/// where the results differ. `on_run` is called after each of visibility_runs() and may throw to
/// stop.
std::vector<VisibilityMeasurement> measure_visibility(LightingBench& bench,
                                                      const DeviceLimits& limits, int runs,
                                                      const std::function<void()>& on_run);
inline int visibility_runs(int runs) { return 2 * runs; }

Table visibility_table(const std::vector<VisibilityMeasurement>& measurements);

}  // namespace kilolux
