// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

#include "host/scene/generated/benchmark/benchmark_scenes.h"

namespace kilolux {

/// Reference pictures of the rows: a step of write_benchmark() each.
std::size_t reference_count(std::span<const BenchmarkScene> scenes);

/// Makes the folder. Throws Error for one that holds other things than a benchmark: its files would
/// replace a README.md of somebody else.
void make_benchmark_folder(const std::filesystem::path& folder);

/// Writes into `folder`, see make_benchmark_folder(): of each row its scene as .glb, its lights as
/// CSV (or the script that computes them), and float64 reference pictures; views.json, README.md,
/// LICENSE.txt. The same rows give the same bytes. `advance` is called after each reference
/// picture. Throws Error.
void write_benchmark(const std::filesystem::path& folder, std::span<const BenchmarkScene> scenes,
                     const std::function<void()>& advance);

}  // namespace kilolux
