// SPDX-License-Identifier: Apache-2.0
// The common part of the files of `kilolux bench`.
#pragma once

#include "host/gpu/tuning/tuning_store.h"
#include "host/measure/bench/run.h"
#include "host/measure/bench/sweep.h"
#include "host/measure/bench/table.h"
#include "present/cli/conditions.h"
#include "present/cli/options.h"
#include "present/commands/error_budget_options.h"
#include "present/program.h"

namespace kilolux {

/// Values of an axis on the command line; without any, the mode chooses.
struct BenchAxes {
    std::optional<std::vector<RendererKind>> renderers;
    std::optional<std::vector<std::array<int, 2>>> resolutions;
    std::optional<std::vector<std::uint64_t>> lights;
    std::optional<std::vector<std::array<int, 3>>> grids;
    std::optional<std::vector<int>> lanes;
    std::optional<std::vector<uint>> gbuffers;
    bool operator==(const BenchAxes&) const = default;
};

struct BenchOptions {
    SharedOptions shared;
    BenchAxes axes;
    std::optional<int> warm_up;
    std::optional<int> frames;
    BenchMotion motion = BenchMotion::camera;
    std::filesystem::path output;     // folder; empty: the table on standard output only
    std::vector<std::string> jobs;    // --job: types of files; empty: frames are measured
    std::vector<std::string> tables;  // --table: CSV files to print instead of measuring
    Shard shard;                      // of the sweep's points
    bool resume = false;
    bool json = false;
    bool quick = false;
    bool tune = false;
    BudgetOptions budget;
    bool operator==(const BenchOptions&) const = default;
};

/// A table as a list of objects; values that were not measured are null.
nlohmann::ordered_json table_json(const Table& table);

/// Creates the folder of -o, unless it is empty; throws Error.
void make_output_folder(const std::filesystem::path& folder);

/// Prints a table, or JSON with --json, and writes <name>.csv, <name>.json and <name>.context.json
/// to the folder of -o.
void put_table(const BenchOptions& options, const std::string& name, const Table& table,
               const nlohmann::ordered_json& context);

/// A CSV file with its context beside it, as results_text() takes them.
void write_table(const std::filesystem::path& csv, const Table& table,
                 const nlohmann::ordered_json& context);

/// Pictures of a job without --frames.
inline constexpr int kJobPictures = 24;

void add_bench_command(Program& program);

}  // namespace kilolux
