// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/merge/results.h"

namespace kilolux {

/// Joins results of report and writes what one run would have written.
void merge_report(const MergeOptions& options, std::vector<Result> results);

}  // namespace kilolux
