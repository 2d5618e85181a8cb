// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "host/measure/report/run.h"

namespace kilolux {

/// Names of the metrics that a budget can use, those of error_metrics() that are errors: against
/// R2, the picture asked for. Prefix `r1-`: against R1, the kernels' error; `r3-`: against R3,
/// where lights have no range.
std::vector<std::string> error_metric_names();

/// An error of a row by its name. Throws UsageError for an unknown one.
double error_of(const ReportRow& row, const std::string& metric);

/// The largest error that is accepted.
struct ErrorBudget {
    double max_error = 0.0;  // >= 0
    std::string metric = "flip";
    bool chooses_shadows = false;  // between sampled shadows, with so many rays, and exact ones
};

/// The setting chosen for a budget.
struct BudgetChoice {
    std::string name;  // of the setting
    RenderSettings settings;
    double error = 0.0;               // by the budget's metric
    double relative = 1.0;            // frame time relative to that of the setting asked for
    std::array<int, 2> error_size{};  // of the picture that `error` was measured on [pixel]
};

/// Whether a budget may choose a setting: one that changes the lights' ranges only if the budget is
/// against R3, other shadows only where it chooses them, and never none.
bool is_candidate(const ReportSetting& setting, const ErrorBudget& budget);

/// The fastest candidate whose error is within the budget. If there is none, throws Error that
/// names the smallest reachable error.
BudgetChoice choose_within(std::span<const ReportRow> rows, const ErrorBudget& budget);

/// Identifies what a choice was measured for: any text, e.g. of scene, view and settings.
using BudgetKey = std::string;

/// The choice stored for this device, driver and key; none if there is none or it is damaged.
std::optional<BudgetChoice> stored_choice(const DeviceInfo& device, const BudgetKey& key,
                                          const std::vector<ReportSetting>& candidates);

/// Stores a choice beside the device's tuning. Throws Error when that cannot be written.
void store_choice(const DeviceInfo& device, const BudgetKey& key, const BudgetChoice& choice);

}  // namespace kilolux
