// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/base/error.h"
#include "kernels/shared/types.h"

namespace kilolux {

/// The most entries that 32-bit offsets address.
inline constexpr uint kMostEntries = 0xfffffff0u;

/// `count` as 32 bits. Throws Error with the stage and `entries`, the name of the list's entries,
/// where 32-bit offsets cannot address so many.
inline uint checked_list_size(std::uint64_t count, std::string_view stage,
                              std::string_view entries) {
    if (count <= kMostEntries) return static_cast<uint>(count);
    throw Error(std::string(stage) + ": " + std::to_string(count) + " " + std::string(entries) +
                " are more than 32 bits number");
}

}  // namespace kilolux
