// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kilolux {

/// What device buffers of one renderer may take together, and take [byte].
struct MemoryBudget {
    std::uint64_t limit = ~std::uint64_t{0};
    std::uint64_t used = 0;
};

}  // namespace kilolux
