// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "host/measure/report/run.h"

namespace kilolux {

/// Errors that a budget can be stated in; each is 0 for equal pictures and larger for worse ones.
///
/// `flip` (mean HDR-FLIP), `ldr-flip` (mean), `rmse`, `max` (largest |x-r|), `max-relative`
/// (largest |x-r| / max(|r|, E)), `relmse`, `codes` (largest difference of 8-bit codes): against
/// R2, the picture asked for. With `r1-` before them against R1, the kernels' error; with `r3-`
/// against R3, where lights have no range.
std::vector<std::string> error_metric_names();

/// An error of a row by its name. Throws UsageError for an unknown one.
double error_of(const ReportRow& row, const std::string& metric);

/// What picture may be how wrong.
struct ErrorBudget {
    double max_error = 0.0;  // >= 0
    std::string metric = "flip";
};

/// A setting that a budget led to.
struct BudgetChoice {
    std::string name;  // of the setting
    RenderSettings settings;
    double error = 0.0;     // by the budget's metric
    double relative = 1.0;  // frame time to that of the setting asked for
};

/// Whether a setting may stand for the picture asked for: not with other ranges of the lights,
/// unless the budget is about those.
bool is_candidate(const ReportSetting& setting, const ErrorBudget& budget);

/// The fastest candidate whose error is within the budget. Throws Error that names the best
/// reachable when there is none.
BudgetChoice choose_within(std::span<const ReportRow> rows, const ErrorBudget& budget);

/// Names, to a cache, what a choice was measured for: any text, e.g. a scene, a view, settings.
using BudgetKey = std::string;

/// The choice kept for this device, driver and key; none if there was none or it is damaged. What
/// a choice changes is taken from the cache, all else from `asked`.
std::optional<BudgetChoice> stored_choice(const DeviceInfo& device, const BudgetKey& key,
                                          const std::vector<ReportSetting>& candidates);

/// Keeps a choice beside the device's tuning. Throws Error when that cannot be written.
void store_choice(const DeviceInfo& device, const BudgetKey& key, const BudgetChoice& choice);

}  // namespace kilolux
