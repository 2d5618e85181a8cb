// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kilolux {

/// The finaliser of splitmix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
/// generators"): a bijection of 64 bits whose every output bit depends on every input bit.
constexpr std::uint64_t mix64(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// Key of an item of a seeded set: counter-based, so that item 7 needs no item 6.
constexpr std::uint64_t item_key(std::uint64_t seed, std::uint64_t item) {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;
    return mix64(mix64(seed + kGolden) + item * kGolden);
}

/// 64 random bits of an item; `stream` tells its properties apart.
constexpr std::uint64_t item_bits(std::uint64_t key, std::uint64_t stream) {
    return mix64(key + (stream + 1) * 0x9e3779b97f4a7c15u);
}

/// A double in [0, 1) of the upper 53 bits: exact, the same on every machine.
constexpr double unit_double(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace kilolux
