// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/measure/bench/table.h"
#include "host/measure/report/compare.h"

namespace kilolux {

/// The texts of report_table() as rows that hold what the other tables of a report show, and what
/// mark_fronts() and row_that_beats_default() compare. Throws Error with the line's number.
std::vector<ReportRow> report_rows(const TextTable& csv);

}  // namespace kilolux
