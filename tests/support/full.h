// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <vector>

namespace kilolux {

/// Whether tests/run --full runs the program: then cases that repeat others run, too.
inline bool runs_full() { return std::getenv("KILOLUX_TEST_FULL") != nullptr; }

/// Lane widths of tests that are alike at each: scalars and the widest, which shipped tunings of
/// CPUs have; in --full all. Those of GPUs have 2: ctest's label `tuning`.
inline std::vector<int> lane_widths() {
    return runs_full() ? std::vector{1, 2, 4, 8, 16} : std::vector{1, 16};
}

}  // namespace kilolux
