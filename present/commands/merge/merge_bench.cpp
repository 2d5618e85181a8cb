// SPDX-License-Identifier: Apache-2.0
#include "present/commands/merge/merge_bench.h"

#include <algorithm>

#include "host/base/system/atomic_write.h"
#include "host/measure/bench/plot.h"
#include "host/measure/bench/row.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/bench/bench_sweep.h"
#include "present/commands/merge/results.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

void add_conditions(Table& table, const std::vector<Result>& results,
                    const std::vector<ResultRow>& order) {
    for (const ConditionColumn& column : kConditionColumns) {
        table.columns.emplace_back(column.name);
        for (std::size_t i = 0; i < order.size(); ++i)
            table.rows[i].emplace_back(condition_of(results[order[i].result], column));
    }
}

// The highest rates and least times that the parts have measured, as a run keeps them.
Json best_limits(const Json& parts) {
    Json out = parts.at(0).at("limits");
    for (const Json& part : parts) {
        for (const auto& [name, value] : part.at("limits").items())
            out[name] =
                name.ends_with("_ms") ? std::min(out[name], value) : std::max(out[name], value);
    }
    return out;
}

}  // namespace

void merge_bench(const MergeOptions& options, std::vector<Result> results) {
    std::vector<std::vector<BenchRow>> found;
    for (Result& result : results) {
        found.push_back(
            complete_points(in_file(result.csv, [&] { return bench_rows(result.table); })));
        std::ranges::transform(found.back(), std::back_inserter(result.points),
                               [](const BenchRow& row) { return point_text(row.point); });
    }
    const std::vector<ResultRow> order = rows_in_order(results);
    std::vector<BenchRow> rows;
    for (const auto& [result, row] : order) rows.push_back(found[result][row]);
    Table table = bench_table(rows);
    Json document = merged_document(results);
    if (options.keep_differences) {
        add_conditions(table, results, order);
    } else {
        document["limits"] = best_limits(document["parts"]);
    }
    const std::filesystem::path csv = options.output / "bench.csv";
    write_atomically(csv, to_csv(table));
    write_json(context_file(csv).string(), document);
    if (!options.keep_differences)
        return put_sweep({options.output, false, can_plot()}, document, rows);
    document["rows"] = table_json(table);
    write_json((options.output / "bench.json").string(), document);
    Table shown = bench_summary(rows);
    add_conditions(shown, results, order);
    print_result(false, document, to_markdown(shown) + "\n" + bench_legend(rows));
}

}  // namespace kilolux
