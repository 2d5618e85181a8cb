// SPDX-License-Identifier: Apache-2.0
// --max-error: the fastest setting within an error budget, for the commands that render.
#pragma once

#include <optional>

#include "host/measure/report/error_budget.h"
#include "present/cli/options.h"

namespace kilolux {

struct BudgetOptions {
    std::optional<double> max_error;
    std::string metric = "flip";
    std::optional<int> error_width;  // [pixel]; none: see ErrorSizeLimits
    bool operator==(const BudgetOptions&) const = default;
};

/// The rows of --max-error, --error-metric and --error-width.
void visit_settings(BudgetOptions& options, const SettingVisitor& visit);

/// The limits that --error-width sets.
ErrorSizeLimits error_limits(const BudgetOptions& options);

/// The settings to render with: those asked for, or, with --max-error, the fastest whose measured
/// error on this scene and device is within it; prints which and why. A choice is stored beside the
/// device's tuning and found again for the same scene, view, settings, metric and budget. Throws
/// Error when no setting is within the budget.
RenderSettings settings_within_budget(const SharedOptions& shared, const BudgetOptions& options,
                                      const ReportView& view);

/// The budget asked for: it chooses sampled shadows' rays, too, where the command line does not.
ErrorBudget budget_of(const SharedOptions& shared, const BudgetOptions& options);

/// The settings among which a budget chooses.
SettingChoice budget_candidates(const ErrorBudget& budget);

/// Chooses among rows that were measured anyway, stores the choice and prints it.
void choose_from_rows(const SharedOptions& shared, const BudgetOptions& options,
                      const ReportView& view, std::span<const ReportRow> rows);

}  // namespace kilolux
