// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <vector>

namespace kilolux {

/// Whether tests/run --full runs the program: then cases that repeat others run, too.
inline bool runs_full() { return std::getenv("KILOLUX_TEST_FULL") != nullptr; }

/// Lane widths to compare: scalars and the widest. In --full also those between; the label `tuning`
/// covers 2, which GPUs use, and 8.
inline std::vector<int> lane_widths() {
    return runs_full() ? std::vector{1, 2, 4, 8, 16} : std::vector{1, 16};
}

}  // namespace kilolux
