// SPDX-License-Identifier: Apache-2.0
#include "present/commands/bench/bench.h"

#include <cstdio>

#include "host/base/error.h"
#include "host/base/system/atomic_write.h"
#include "host/render/plan/settings_check.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"
#include "present/cli/sequence.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/bench/bench_job.h"
#include "present/commands/bench/bench_options.h"
#include "present/commands/bench/bench_sweep.h"
#include "present/commands/bench/bench_tune.h"
#include "present/program.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

void check(const BenchOptions& o) {
    const int modes = o.tune + o.quick + !o.jobs.empty();
    if (!o.tables.empty() && (modes > 0 || !o.output.empty())) {
        throw UsageError("--table: prints what was measured; it goes with no other mode and no -o");
    }
    if (modes > 1) throw UsageError("--quick, --tune and --job exclude each other");
    if (o.budget.max_error && o.tune)
        throw UsageError("--max-error: goes with sweeps, not with --tune");
    refuse_if(o.shard.count > 1 && (o.tune || !o.jobs.empty() || !o.tables.empty()),
              "--shard: goes with sweeps, not with --tune, --job or --table");
    refuse_if(o.shard.count > 1 && o.budget.max_error.has_value(),
              "--shard: --max-error would choose other settings in each shard");
    if (o.resume && !o.jobs.empty()) throw UsageError("--resume: goes with sweeps, not with --job");
    if (o.resume && o.output.empty()) throw UsageError("--resume: needs the folder of -o");
}

void run_bench(BenchOptions& options) {
    check(options);
    begin_command(options.shared);
    check_progress(options.shared.progress, options.json);
    measure_swarm(options.shared);
    if (!options.tables.empty()) {
        std::fputs(results_text(options.tables).c_str(), stdout);
        return;
    }
    for (const SweepPoint& point : bench_points(options)) {
        check_settings(settings_at(options.shared.settings, point));
    }
    note_shard(options.shard);
    make_output_folder(options.output);
    if (options.tune) return run_tuning(options);
    if (!options.jobs.empty()) return run_jobs(options);
    run_sweep(options);
}

constexpr const char* kBenchExamples =
    "  kilolux bench\n"
    "  kilolux bench --quick -o results\n"
    "  kilolux bench --lights 500:5000:500 --renderer deferred,deferred-all -o results\n"
    "  kilolux bench --lights 256:8192:*2 --resolution '1280,720;1920,1080' --frames 30\n"
    "  kilolux bench --grid '4,4,1;16,9,4;64,36,64' --lanes 1,8 -o results --resume\n"
    "  kilolux bench --lights 1000:64000:1000 -o part.3 --shard 3/8\n"
    "  kilolux bench --job png,exr,y4m --lights 8192 -o results\n"
    "  kilolux bench --tune\n"
    "  kilolux bench --table results/bench.csv";

}  // namespace

Json table_json(const Table& table) {
    Json rows = Json::array();
    for (const auto& row : table.rows) {
        Json out;
        for (std::size_t i = 0; i < row.size(); ++i) {
            out[table.columns[i]] = std::visit(
                [](const auto& value) {
                    using Value = std::decay_t<decltype(value)>;
                    if constexpr (std::is_same_v<Value, std::monostate>)
                        return Json(nullptr);
                    else
                        return Json(value);
                },
                row[i]);
        }
        rows.push_back(std::move(out));
    }
    return rows;
}

void make_output_folder(const std::filesystem::path& folder) {
    if (folder.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder)) {
        throw Error(folder.string() + ": cannot make this folder: " +
                    (error ? error.message() : "a file has its name"));
    }
}

void put_table(const BenchOptions& options, const std::string& name, const Table& table,
               const Json& context) {
    const Json document = {
        {"command", command_line()}, {"context", context}, {"rows", table_json(table)}};
    print_result(options.json, document, to_markdown(table));
    if (options.output.empty()) return;
    write_json((options.output / (name + ".json")).string(), document);
    write_table(options.output / (name + ".csv"), table, context);
}

void write_table(const std::filesystem::path& csv, const Table& table, const Json& context) {
    write_atomically(csv, to_csv(table));
    write_json(context_file(csv).string(), {{"command", command_line()}, {"context", context}});
}

void add_bench_command(Program& program) {
    program.add_command(
        "bench", "Measure times against the device's limits, over lights, sizes and settings",
        kBenchExamples, add_bench_options, run_bench);
}

}  // namespace kilolux
