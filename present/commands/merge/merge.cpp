// SPDX-License-Identifier: Apache-2.0
#include "present/commands/merge/merge.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/read_text.h"
#include "host/measure/bench/row.h"
#include "present/cli/conditions.h"
#include "present/cli/option_builder.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/merge/merge_bench.h"
#include "present/commands/merge/merge_report.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The CSV in a folder of -o; a path that is no folder is the CSV.
fs::path csv_of(const fs::path& result) {
    if (!fs::is_directory(result)) return result;
    const fs::path bench = result / "bench.csv", report = result / "report.csv";
    const bool has_bench = fs::exists(bench);
    if (has_bench != fs::exists(report)) return has_bench ? bench : report;
    throw Error(fmt::format("{}: has {} bench.csv {} report.csv", result.string(),
                            has_bench ? "both" : "neither", has_bench ? "and" : "nor"));
}

Result read_result(const fs::path& result) {
    Result out{csv_of(result), {}, {}};
    fs::path document = context_file(out.csv);
    const std::string text = read_text(out.csv);
    out.table = in_file(out.csv, [&] { return parse_csv(whole_lines(text)); });
    if (!is_bench_table(out.table)) document = fs::path(out.csv).replace_extension(".json");
    out.document = Json::parse(read_text(document), nullptr, false);
    if (!out.document.is_object() || !out.document.contains("context") ||
        !out.document.contains("points")) {
        throw Error(document.string() + ": has no context or no list of the sweep's points");
    }
    if (is_bench_table(out.table) && !out.document.value("limits", Json()).is_object())
        throw Error(document.string() + ": has no limits: the run did not end; --resume ends it");
    return out;
}

// Throws where a result is of another sweep than the first one, or was measured under other
// conditions, but for those that are kept as columns.
void require_one_sweep(const std::vector<Result>& results, bool keep_differences) {
    const auto context_of = [&](const Result& result) {
        Json out = result.document["context"];
        // It differs between nodes of one kind, and over time; scenes that fit have the same times.
        if (out.contains("device")) out["device"].erase("memory_bytes");
        if (keep_differences) {
            for (const char* kept : {"program", "device", "tuning"}) out.erase(kept);
        }
        return out;
    };
    const auto points_of = [](const Result& result) {
        return Json{{"points", result.document["points"]}};
    };
    const Result& first = results.front();
    for (const Result& result : results) {
        std::string difference = first_difference(context_of(first), context_of(result));
        if (difference.empty()) difference = first_difference(points_of(first), points_of(result));
        if (difference.empty()) continue;
        throw Error(fmt::format("{}: measured under other conditions than {}: {}",
                                result.csv.string(), first.csv.string(), difference));
    }
}

void run_merge(MergeOptions& options) {
    refuse_if(options.output.empty(), "--output: needs a folder, e.g. -o whole");
    if (options.quiet) set_verbosity(Verbosity::quiet);
    std::vector<Result> results;
    for (const fs::path& result : options.results) {
        results.push_back(read_result(result));
        const fs::path folder = fs::absolute(results.back().csv).parent_path();
        std::error_code none;
        refuse_if(fs::equivalent(folder, options.output, none),
                  "--output: " + options.output.string() +
                      " holds one of the results to merge; choose another folder");
    }
    const bool is_bench = is_bench_table(results.front().table);
    for (const Result& result : results) {
        if (is_bench_table(result.table) == is_bench) continue;
        throw Error(fmt::format("{}: bench and report cannot be merged, and {} is of the other",
                                results.front().csv.string(), result.csv.string()));
    }
    refuse_if(!is_bench && options.keep_differences,
              "--keep-differences: the settings of a report compare on one device only");
    refuse_if(is_bench && options.check_default, "--check-default: goes with results of report");
    require_one_sweep(results, options.keep_differences);
    make_output_folder(options.output);
    if (is_bench) return merge_bench(options, std::move(results));
    merge_report(options, std::move(results));
}

constexpr const char* kMergeExamples =
    "  kilolux merge -o whole part.0 part.1 part.2\n"
    "  kilolux merge -o both old new --keep-differences";

}  // namespace

void visit_settings(MergeOptions& options, const SettingVisitor& f) {
    OptionBuilder(f, "Output")
        .text({"--output,-o", "DIR", "", "Folder for what one run would have written"},
              options.output)
        .flag("--keep-differences", options.keep_differences,
              "Also join sweeps of several commits, devices and drivers, with a column for each")
        .flag("--check-default", options.check_default,
              "Exit with 3 where another setting of a report is faster beyond noise and as exact")
        .flag("--quiet,-q", options.quiet, "Only warnings and errors on stderr");
}

void add_merge_options(CLI::App& command, MergeOptions& options) {
    command
        .add_option("RESULT", options.results,
                    "Folders of bench -o or report -o, or their CSV files, in any order")
        ->required()
        ->type_name("DIR");
    add_options(command, options);
}

void add_merge_command(Program& program) {
    program.add_command("merge", "Join the results of shards of bench or report", kMergeExamples,
                        add_merge_options, run_merge);
}

}  // namespace kilolux
