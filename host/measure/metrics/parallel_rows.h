// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace kilolux {

/// Receives the finished share of a long computation, 0..1, never decreasing. Called from worker
/// threads, one at a time. An exception that it throws stops the computation and leaves the
/// function that runs it.
using OnProgress = std::function<void(double)>;

/// Calls `body(row)` once for every row in [0, count), on all cores, in any order.
///
/// Rethrows an exception of `body` or `progress` after all threads have stopped.
void parallel_rows(int count, const std::function<void(int)>& body,
                   const OnProgress& progress = {});

}  // namespace kilolux
