// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/bench/bench.h"

namespace kilolux {

/// The points of the sweeps, each once.
std::vector<SweepPoint> bench_points(const BenchOptions& options);
BenchFrames bench_frames(const BenchOptions& options);

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

void run_sweep(BenchOptions& options);

}  // namespace kilolux
