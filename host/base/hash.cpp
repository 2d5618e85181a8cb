// SPDX-License-Identifier: Apache-2.0
#include "host/base/hash.h"

// The header alone: the installed library needs no libxxhash.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdio>

namespace kilolux {

std::uint64_t hash64(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

std::uint64_t hash64(std::string_view text) {
    return hash64(std::as_bytes(std::span(text.data(), text.size())));
}

std::string hash_text(std::string_view text) {
    char digits[17];
    std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(hash64(text)));
    return digits;
}

}  // namespace kilolux
