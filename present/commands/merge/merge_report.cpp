// SPDX-License-Identifier: Apache-2.0
#include "present/commands/merge/merge_report.h"

#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/measure/report/columns.h"
#include "host/measure/report/tables.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/merge/results.h"
#include "present/commands/report.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

std::size_t place_of(const Names& names, const std::string& name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) throw Error("lacks the column '" + name + "'");
    return static_cast<std::size_t>(found - names.begin());
}

std::string field_of(const TextTable& table, std::size_t row, const std::string& column) {
    const auto found = std::ranges::find(table.columns, column);
    if (found == table.columns.end()) return "";
    return table.rows[row][static_cast<std::size_t>(found - table.columns.begin())];
}

// The texts of all results, with the columns of one run's table.
TextTable merged_table(const std::vector<Result>& results, const std::vector<ResultRow>& order,
                       const std::vector<ReportColumn>& columns) {
    TextTable out;
    for (const ReportColumn& column : columns) {
        const auto has_it = [&](const Result& result) {
            return std::ranges::count(result.table.columns, column.name) > 0;
        };
        if (std::ranges::any_of(results, has_it)) out.columns.push_back(column.name);
    }
    for (const auto& [result, row] : order) {
        Names& fields = out.rows.emplace_back();
        for (const std::string& column : out.columns)
            fields.push_back(field_of(results[result].table, row, column));
    }
    return out;
}

// The rows of a report's table. Throws Error that names the file for any other.
std::vector<ReportRow> rows_of(const Result& result) {
    return in_file(result.csv, [&] {
        for (const ReportColumn& column : report_columns({})) {
            if (column.is_shown == nullptr) place_of(result.table.columns, column.name);
        }
        return report_rows(result.table);
    });
}

// Every shard has the default, with whose frames its own are paired: times relative to it compare,
// and the first shard's stands for all. Returns the rows of each result.
std::vector<std::vector<ReportRow>> keep_own_rows(std::vector<Result>& results) {
    std::vector<std::vector<ReportRow>> parts;
    for (Result& result : results) {
        std::vector<ReportRow> rows = rows_of(result);
        TextTable& table = result.table;
        const bool is_first = result.document.value("shard", "0/1").starts_with("0/");
        if (!is_first && !rows.empty()) {
            rows.erase(rows.begin());
            table.rows.erase(table.rows.begin());
        }
        parts.push_back(std::move(rows));
        for (std::size_t row = 0; row < table.rows.size(); ++row)
            result.points.push_back(field_of(table, row, "setting"));
    }
    return parts;
}

std::vector<ReportRow> joined_rows(const std::vector<std::vector<ReportRow>>& parts,
                                   const std::vector<ResultRow>& order, const Json& context) {
    std::vector<ReportRow> rows;
    for (const auto& [result, place] : order) {
        ReportRow& row = rows.emplace_back(parts[result][place]);
        row.setting.settings.width = context.at("resolution").at(0);
        row.setting.settings.height = context.at("resolution").at(1);
        row.speed.frame_ms = row.speed.relative * rows.front().speed.frame_ms;
    }
    mark_fronts(rows);
    return rows;
}

// The texts as cells, but for values that depend on all rows.
Table joined_table(const TextTable& texts, const std::vector<ReportColumn>& columns,
                   const std::vector<ReportRow>& rows) {
    Table out = table_of(texts);
    for (const ReportColumn& column : columns) {
        if (!column.is_text && !column.of_all_rows) continue;
        const std::size_t place = place_of(out.columns, column.name);
        for (std::size_t row = 0; row < rows.size(); ++row) {
            Cell& cell = out.rows[row][place];
            const bool is_empty = std::holds_alternative<std::monostate>(cell);
            if (column.of_all_rows) {
                cell = column.cell(rows[row]);
            } else if (is_empty) {
                cell = std::string();
            }
        }
    }
    return out;
}

void copy_error_maps(const fs::path& folder, const std::vector<Result>& results,
                     const std::vector<ResultRow>& order) {
    make_output_folder(folder / "errors");
    for (const auto& [result, row] : order) {
        const std::string& setting = results[result].points[row];
        const fs::path from = error_map_file(results[result].csv.parent_path(), setting);
        std::error_code error;
        fs::copy_file(from, error_map_file(folder, setting), fs::copy_options::overwrite_existing,
                      error);
        if (error) warn(from.string() + ": cannot be copied: " + error.message());
    }
}

}  // namespace

void merge_report(const MergeOptions& options, std::vector<Result> results) {
    const std::vector<std::vector<ReportRow>> parts = keep_own_rows(results);
    const std::vector<ResultRow> order = rows_in_order(results);
    Json document = merged_document(results);
    const Json context = document.at("context");
    const std::vector<ReportRow> rows = joined_rows(parts, order, context);
    const std::vector<ReportColumn> columns = report_columns(stage_names(rows));
    const Table table = joined_table(merged_table(results, order, columns), columns, rows);
    document["rows"] = table_json(table);
    const fs::path& folder = options.output;
    const std::string text = to_markdown(report_summary(rows), 3) + "\n" + report_notes(rows);
    write_atomically(folder / "report.csv", to_csv(table));
    write_atomically(folder / "report.md", text);
    write_json((folder / "report.json").string(), document);
    print_result(false, document, text);
    const Table cut_offs = cut_off_table(rows);
    if (!cut_offs.rows.empty()) write_table(folder / "cut_offs.csv", cut_offs, context);
    copy_error_maps(folder, results, order);
    if (can_plot()) write_plots(report_plots(rows, report_caption(context)), folder);
    note("wrote   " + folder.string());
    judge_default(rows, options.check_default);
}

}  // namespace kilolux
