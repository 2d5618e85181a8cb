// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench/plot.h"
#include "host/measure/bench/table.h"
#include "host/measure/report/run.h"

namespace kilolux {

/// Everything that is measured: times of every stage, counts, every error against each reference.
Table report_table(const std::vector<ReportRow>& rows);

/// The columns that matter, for reading.
Table report_summary(const std::vector<ReportRow>& rows);

/// The rows about lights without a range: time, lights evaluated, error and estimated error.
/// Without rows where the report has none but the default.
Table cut_off_table(const std::vector<ReportRow>& rows);

/// Explains the summary's columns and says at which sizes they were measured; some lines.
std::string report_notes(const std::vector<ReportRow>& rows);

/// Frame time against RMSE, with the Pareto front: against R2 for the settings that keep the
/// lights' ranges; against R3 for the cut-offs. Where rows have them, also against the pictures'
/// bounds and standard errors, and against the cut-off. `caption`: what was measured.
std::vector<NamedPlot> report_plots(const std::vector<ReportRow>& rows, const std::string& caption);

}  // namespace kilolux
