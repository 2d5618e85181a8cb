// SPDX-License-Identifier: Apache-2.0
// Random numbers as hashes of their use: the same on every run, grid and device.
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

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
