// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace kilolux {

/// Calls work(0) ... work(count - 1) on all cores; when some throw, rethrows that of the lowest
/// index.
void parallel_each(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace kilolux
