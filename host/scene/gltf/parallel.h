// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_for.h>

#include <exception>
#include <vector>

namespace kilolux {

/// Calls work(0) ... work(count - 1) on all cores. When some throw, the others still run, and the
/// exception of the lowest index is rethrown: the same message on any number of threads.
template <typename Work>
void parallel_each(std::size_t count, const Work& work) {
    std::vector<std::exception_ptr> errors(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        try {
            work(i);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
}

}  // namespace kilolux
