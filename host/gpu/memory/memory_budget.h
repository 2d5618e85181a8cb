// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kilolux {

/// The limit of the device buffers of one renderer together, and their present sum [byte].
struct MemoryBudget {
    std::uint64_t limit = ~std::uint64_t{0};
    std::uint64_t used = 0;
};

}  // namespace kilolux
