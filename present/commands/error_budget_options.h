// SPDX-License-Identifier: Apache-2.0
// --max-error: the fastest setting that is right enough, for the commands that render.
#pragma once

#include <CLI/App.hpp>
#include <optional>

#include "host/measure/report/error_budget.h"
#include "present/cli/options.h"

namespace kilolux {

struct BudgetOptions {
    std::optional<double> max_error;
    std::string metric = "flip";
    std::optional<int> error_width;  // [pixel]; none: see ErrorSizeLimits
};

/// Registers --max-error, --error-metric and --error-width.
void add_budget_options(CLI::App& command, BudgetOptions& options);
void visit_budget_settings(BudgetOptions& options, const SettingVisitor& visit);

/// The limits that --error-width sets.
ErrorSizeLimits error_limits(const BudgetOptions& options);

/// The settings to render with: those asked for, or, with --max-error, the fastest whose measured
/// error on this scene and device is within it; says which and why. A choice is kept beside the
/// device's tuning and found again by the same scene, view, settings, metric and budget. Throws
/// Error when no setting is within the budget.
RenderSettings settings_within_budget(const SharedOptions& shared, const BudgetOptions& options,
                                      const ReportView& view);

/// The budget asked for: with sampled shadows whose rays were not, it chooses those, too.
ErrorBudget budget_of(const SharedOptions& shared, const BudgetOptions& options);

/// What report_settings() goes through for a budget.
SettingChoice budget_candidates(const ErrorBudget& budget);

/// Chooses among rows that were measured anyway, keeps the choice and says it.
void choose_from_rows(const SharedOptions& shared, const BudgetOptions& options,
                      const ReportView& view, std::span<const ReportRow> rows);

}  // namespace kilolux
