// SPDX-License-Identifier: Apache-2.0
#include "present/commands/merge/merge_report.h"

#include <algorithm>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/measure/report/table_rows.h"
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

// The columns of stages stand between these, those of estimates at the end.
constexpr const char* kBeforeStages = "scaled";
constexpr const char* kAfterStages = "k";
constexpr const char* kTextColumns[] = {"setting", "axis", "options", "pareto", "scaled"};

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

// The columns of one run's table: of stages in the order in which its rows have them.
Names merged_columns(const std::vector<Result>& results, const std::vector<ResultRow>& order) {
    const Names& first = results.front().table.columns;
    const auto offset = [](std::size_t place) { return static_cast<std::ptrdiff_t>(place); };
    Names out(first.begin(), first.begin() + offset(place_of(first, kBeforeStages) + 1)), rest;
    for (const auto& [result, row] : order) {
        const TextTable& table = results[result].table;
        const std::size_t end = place_of(table.columns, kAfterStages);
        for (std::size_t i = place_of(table.columns, kBeforeStages) + 1; i < end; ++i) {
            const std::string& name = table.columns[i];
            const bool is_new = std::ranges::find(out, name) == out.end();
            if (is_new && !table.rows[row][i].empty()) out.push_back(name);
        }
        Names behind(table.columns.begin() + offset(end), table.columns.end());
        if (behind.size() > rest.size()) rest = std::move(behind);
    }
    out.insert(out.end(), rest.begin(), rest.end());
    return out;
}

TextTable merged_table(const std::vector<Result>& results, const std::vector<ResultRow>& order) {
    TextTable out{merged_columns(results, order), {}};
    for (const auto& [result, row] : order) {
        Names& fields = out.rows.emplace_back();
        for (const std::string& column : out.columns)
            fields.push_back(field_of(results[result].table, row, column));
    }
    return out;
}

// Throws Error that names the file unless it is the table of a report.
void require_report(const Result& result) {
    try {
        place_of(result.table.columns, kBeforeStages);
        place_of(result.table.columns, kAfterStages);
        report_rows(result.table);
    } catch (const Error& error) {
        throw Error(result.csv.string() + ": " + error.what());
    }
}

// Every shard has the default, with whose frames its own are paired: times relative to it compare,
// and the first shard's stands for all.
void keep_own_rows(std::vector<Result>& results) {
    for (Result& result : results) {
        TextTable& table = result.table;
        const bool is_first = result.document.value("shard", "0/1").starts_with("0/");
        if (!is_first && !table.rows.empty()) table.rows.erase(table.rows.begin());
        for (std::size_t row = 0; row < table.rows.size(); ++row)
            result.points.push_back(field_of(table, row, "setting"));
    }
}

std::vector<ReportRow> joined_rows(const TextTable& texts, const Json& context) {
    std::vector<ReportRow> rows = report_rows(texts);
    for (ReportRow& row : rows) {
        row.setting.settings.width = context.at("resolution").at(0);
        row.setting.settings.height = context.at("resolution").at(1);
        row.speed.frame_ms = row.speed.relative * rows.front().speed.frame_ms;
    }
    mark_fronts(rows);
    return rows;
}

// report_table() of the rows, of which `texts` has every column.
Table table_with_fronts(const TextTable& texts, const std::vector<ReportRow>& rows) {
    Table out = table_of(texts);
    const Table fronts = report_table(rows);
    for (const char* column : {"pareto", "frame [ms]"}) {
        const std::size_t to = place_of(out.columns, column);
        const std::size_t from = place_of(fronts.columns, column);
        for (std::size_t row = 0; row < rows.size(); ++row)
            out.rows[row][to] = fronts.rows[row][from];
    }
    for (const char* column : kTextColumns) {
        for (std::vector<Cell>& cells : out.rows) {
            Cell& cell = cells[place_of(out.columns, column)];
            if (std::holds_alternative<std::monostate>(cell)) cell = std::string();
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
    std::ranges::for_each(results, require_report);
    keep_own_rows(results);
    const std::vector<ResultRow> order = rows_in_order(results);
    const TextTable texts = merged_table(results, order);
    Json document = merged_document(results);
    const Json context = document.at("context");
    const std::vector<ReportRow> rows = joined_rows(texts, context);
    const Table table = table_with_fronts(texts, rows);
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
