// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace kilolux {

/// Told how many of a file's images are decoded, which is what loading takes longest for: first
/// with 0, then after each. Never called by two threads at once.
using LoadProgress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace kilolux
