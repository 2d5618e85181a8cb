// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/bench/bench.h"

namespace kilolux {

void run_jobs(BenchOptions& options);

}  // namespace kilolux
