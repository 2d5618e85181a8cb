// SPDX-License-Identifier: Apache-2.0
// Random numbers as hashes of their use: the same on every run, grid and device. Those of 64 bits
// are of the items of a seeded set: item 7 needs no item 6.
#ifndef KILOLUX_SHARED_HASH_H
#define KILOLUX_SHARED_HASH_H
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// A hash of 32 bits (Wellons, "hash-prospector", lowbias32).
SHARED_FN uint hash_of(uint x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

// In [0, 1), in steps of 2^-24.
SHARED_FN float random_of(uint hash) { return float_of(hash >> 8) * (1.0f / 16777216.0f); }

// GLSL has no integers of 64 bits.
#if !defined(GL_core_profile)
// 2^64 over the golden ratio, odd.
#define HASH_STEP 0x9e3779b97f4a7c15ul

// The finaliser of splitmix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
// generators"): a bijection of 64 bits whose every output bit depends on every input bit.
SHARED_FN ulong mix64(ulong x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ul;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebul;
    return x ^ (x >> 31);
}

// Key of an item.
SHARED_FN ulong item_key(ulong seed, ulong item) {
    return mix64(mix64(seed + HASH_STEP) + item * HASH_STEP);
}

// 64 random bits of an item; `stream` tells its properties apart.
SHARED_FN ulong item_bits(ulong key, ulong stream) {
    return mix64(key + (stream + 1ul) * HASH_STEP);
}

#if defined(__cplusplus)
// In [0, 1), of the upper 53 bits: exact, the same on every machine.
SHARED_FN double unit_double(ulong bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }
#endif
#endif

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
