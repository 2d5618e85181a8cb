// SPDX-License-Identifier: Apache-2.0
// The columns of report_table(), for tables, for reading them back, and for merging them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "host/measure/bench/table.h"
#include "host/measure/report/compare.h"

namespace kilolux {

/// A column: its name, what it shows of a row, and how a row takes that back.
struct ReportColumn : Column<ReportRow> {
    using Column::Column;

    /// Reads the text back into the row. Throws Error for a text that is no value. Empty: the
    /// column is not read back.
    std::function<void(ReportRow& row, const std::string& text)> take{};
    /// Whether a table of these rows has the column; null: always.
    bool (*is_shown)(const std::vector<ReportRow>& rows) = nullptr;
    bool is_text = false;      // an empty field is an empty text; in other columns a missing value
    bool of_all_rows = false;  // its value depends on the other rows of the table
};

/// All columns in the order of report_table(), with those of the stages in their place.
std::vector<ReportColumn> report_columns(const std::vector<std::string>& stages);

/// The columns of the estimated errors, which are the last ones.
std::vector<ReportColumn> estimate_columns();

/// The median time of a stage.
ReportColumn stage_column(const std::string& name, std::string_view stage);

/// The stages of all rows, in the order in which rows have them.
std::vector<std::string> stage_names(const std::vector<ReportRow>& rows);

/// The texts of report_table() as rows, which hold what columns take. Throws Error with the line's
/// number.
std::vector<ReportRow> report_rows(const TextTable& csv);

}  // namespace kilolux
