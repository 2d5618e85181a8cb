// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/merge/results.h"

namespace kilolux {

/// Joins results of bench and writes what one run would have written.
void merge_bench(const MergeOptions& options, std::vector<Result> results);

}  // namespace kilolux
