// SPDX-License-Identifier: Apache-2.0
// The common part of the files of `kilolux bench`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/gpu/tuning/tuning_store.h"
#include "host/measure/bench/run.h"
#include "host/measure/bench/sweep.h"
#include "host/measure/bench/table.h"
#include "present/cli/conditions.h"
#include "present/cli/options.h"
#include "present/commands/error_budget_options.h"

namespace kilolux {

/// Values of an axis on the command line; without any, the mode chooses.
struct BenchAxes {
    std::optional<std::vector<RendererKind>> renderers;
    std::optional<std::vector<std::array<int, 2>>> resolutions;
    std::optional<std::vector<std::uint64_t>> lights;
    std::optional<std::vector<std::array<int, 3>>> grids;
    std::optional<std::vector<int>> lanes;
    std::optional<std::vector<uint>> gbuffers;
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
};

/// Registers the shared options, which take lists where a sweep varies them, and the bench's own.
void add_bench_options(CLI::App& command, BenchOptions& options);

/// Resolutions "W,H;W,H" and grids "X,Y,S;X,Y,S"; 1920x1080 is 1920,1080. Throw UsageError.
std::vector<std::array<int, 2>> parse_resolutions(const std::string& option,
                                                  const std::string& text);
std::vector<std::array<int, 3>> parse_grids(const std::string& option, const std::string& text);

/// The points of the sweeps, each once.
std::vector<SweepPoint> bench_points(const BenchOptions& options);
BenchFrames bench_frames(const BenchOptions& options);

/// The command line of this process, as words for a shell.
std::string command_line();

nlohmann::ordered_json tuning_json(const StoredTuning& tuning);
/// Of tuning_json(): "lanes 8, group_height 4".
std::string tuning_text(const nlohmann::ordered_json& tuning);

/// The conditions of results: program, device, tuning in force, scene, camera and everything else
/// that is constant over a run.
nlohmann::ordered_json bench_context(const SharedOptions& shared, const BenchFrames& frames,
                                     const Scene& scene, const Camera& camera,
                                     const DeviceInfo& device);

/// Throws Error unless the context file was written by the same shard with the same context.
void require_same_context(const std::filesystem::path& file,
                          const nlohmann::ordered_json& document);

/// A measurement's document: the command, its context, and the names of all points of the run. That
/// of a shard also has "shard", the text I/N.
nlohmann::ordered_json result_document(const nlohmann::ordered_json& context,
                                       const std::vector<std::string>& points, const Shard& shard);

/// The context of a CSV's measurements: X.context.json beside X.csv.
std::filesystem::path context_file(std::filesystem::path csv);

nlohmann::ordered_json limits_json(const DeviceLimits& limits);

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

/// The tables of CSV files that a bench wrote, in Markdown, each with the command and the context
/// that it was measured with. Throws Error for a file that is none or that lacks its context.
std::string results_text(const std::vector<std::string>& csv_files);

/// Where the results of a sweep go.
struct SweepOutput {
    std::filesystem::path folder;  // empty: standard output only
    bool json = false;
    bool plots = false;
    bool every_stage = false;  // of many points, too
};

/// Prints rows, and writes bench.json and plots. `document`: all but the rows.
void put_sweep(const SweepOutput& output, nlohmann::ordered_json document,
               const std::vector<BenchRow>& rows);

/// A scene and its settings for one point: the first value of each axis. `usual_runs`: without
/// --frames.
struct BenchScene {
    BenchScene(BenchOptions& options, int usual_runs);

    Scene scene;
    Camera camera;
    RenderSettings settings;
    int runs;  // after one that warms up
    nlohmann::ordered_json context;
};

/// The modes.
void run_sweep(BenchOptions& options);
void run_tuning(BenchOptions& options);
void run_jobs(BenchOptions& options);

/// Pictures of a job without --frames.
inline constexpr int kJobPictures = 24;

}  // namespace kilolux
