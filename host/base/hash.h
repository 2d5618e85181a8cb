// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kilolux {

/// FNV-1a, 64 bits (Fowler, Noll, Vo): names cache entries and compares pictures. Not for security.
class Fnv1a {
 public:
    /// Adds each byte of `text`.
    constexpr Fnv1a& add(std::string_view text) {
        for (const char c : text) mix(static_cast<unsigned char>(c));
        return *this;
    }
    /// Adds each 32-bit word in one step: four times as fast as by bytes, and another hash.
    constexpr Fnv1a& add_words(std::span<const std::uint32_t> words) {
        for (const std::uint32_t word : words) mix(word);
        return *this;
    }
    constexpr std::uint64_t value() const { return hash_; }

    /// 16 hexadecimal digits.
    std::string hex() const {
        std::string digits(16, '0');
        for (std::size_t i = 0; i < 16; ++i) {
            digits[i] = "0123456789abcdef"[hash_ >> (60 - 4 * i) & 15u];
        }
        return digits;
    }

 private:
    constexpr void mix(std::uint64_t value) { hash_ = (hash_ ^ value) * 0x100000001b3u; }

    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

// "foobar" of the authors' test vectors.
static_assert(Fnv1a().add("foobar").value() == 0x85944171f73967e8u);

}  // namespace kilolux
