// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/bench/bench.h"

namespace kilolux {

/// The shared options, which take lists where a sweep varies them, and the bench's own.
void visit_settings(BenchOptions& options, const SettingVisitor& visit);
void add_bench_options(CLI::App& command, BenchOptions& options);

/// Resolutions "W,H;W,H" and grids "X,Y,S;X,Y,S"; 1920x1080 is 1920,1080. Throw UsageError.
std::vector<std::array<int, 2>> parse_resolutions(const std::string& option,
                                                  const std::string& text);
std::vector<std::array<int, 3>> parse_grids(const std::string& option, const std::string& text);

}  // namespace kilolux
