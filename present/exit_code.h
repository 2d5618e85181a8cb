// SPDX-License-Identifier: Apache-2.0
// Turns a failure into one line on stderr and an exit code.
#pragma once

#include <functional>

namespace kilolux {

/// Runs `work`. Returns 0, or prints the exception, of any type, and returns 1 (runtime error), 2
/// (command line), 3 (comparison failed) or 128 + N (interrupted by signal N).
int exit_code_of(const std::function<void()>& work);

/// Makes uncaught exceptions, such as in a worker thread, end the process as exit_code_of() would
/// instead of by std::abort().
void end_on_uncaught_exceptions();

}  // namespace kilolux
