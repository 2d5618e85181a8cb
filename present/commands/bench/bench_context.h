// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/tuning/tuning_store.h"
#include "host/measure/bench/run.h"
#include "host/measure/bench/sweep.h"
#include "host/measure/bench/table.h"
#include "present/cli/conditions.h"
#include "present/cli/options.h"
#include "present/commands/error_budget_options.h"

namespace kilolux {

/// The command line of this process, as words for a shell.
std::string command_line();

nlohmann::ordered_json tuning_json(const StoredTuning& tuning);

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

nlohmann::ordered_json limits_json(const DeviceLimits& limits);

/// Of tuning_json(): "lanes 8, group_height 4".
std::string tuning_text(const nlohmann::ordered_json& tuning);

/// The context of a CSV's measurements: X.context.json beside X.csv.
std::filesystem::path context_file(std::filesystem::path csv);

/// The tables of CSV files that a bench wrote, in Markdown, each with the command and the context
/// that it was measured with. Throws Error for a file that is none or that lacks its context.
std::string results_text(const std::vector<std::string>& csv_files);

}  // namespace kilolux
