// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/bench/bench.h"

namespace kilolux {

/// The points of the sweeps, each once.
std::vector<SweepPoint> bench_points(const BenchOptions& options);
BenchFrames bench_frames(const BenchOptions& options);

/// The modes.
void run_sweep(BenchOptions& options);

}  // namespace kilolux
