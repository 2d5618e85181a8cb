// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/measure/bench/plot.h"
#include "host/measure/bench/table.h"
#include "host/measure/report/run.h"

namespace kilolux {

/// All that rows hold: times of every stage, counts, and every error against each reference.
Table report_table(const std::vector<ReportRow>& rows);

/// For reading: one line a setting with the columns that matter.
Table report_summary(const std::vector<ReportRow>& rows);

/// Frame time against an error's RMSE with the Pareto front of the points: against R2 for the
/// settings with the lights' ranges asked for; against R3 for the cut-offs.
Plot surfaces_plot(const std::vector<ReportRow>& rows);
Plot unbounded_plot(const std::vector<ReportRow>& rows);

}  // namespace kilolux
