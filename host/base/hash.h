// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kilolux {

/// XXH3, 64 bits (Collet, xxhash 0.8): names cache entries, compares pictures and files. Not for
/// security.
std::uint64_t hash64(std::span<const std::byte> bytes);
std::uint64_t hash64(std::string_view text);

/// hash64() as 16 hexadecimal digits.
std::string hash_text(std::string_view text);

}  // namespace kilolux
