// SPDX-License-Identifier: Apache-2.0
// The order in which kernels go through lights: along a Hilbert curve through cells. Neighbours in
// the order are neighbours in space, so the box of a run of lights is small.
#ifndef KILOLUX_SHARED_LIGHTS_LIGHT_ORDER_H
#define KILOLUX_SHARED_LIGHTS_LIGHT_ORDER_H
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// Cell numbers have either sign, and a key keeps 11 bits of them: cells 2048 apart share keys.
// Lights LIGHT_CELLS cells or more from the origin, or with a NaN, are in cell LIGHT_CELL_FAR along
// that axis.
#define LIGHT_CELLS 16777216.0f
#define LIGHT_CELL_FAR 0xffffffffu
#define LIGHT_CELL_BIT 1024u  // the highest of a key

// The 11 lower bits, two zeros between each.
SHARED_FN uint spread_bits(uint x) {
    x = x & 0x7ffu;
    x = (x | x << 16) & 0x70000ffu;
    x = (x | x << 8) & 0x700f00fu;
    x = (x | x << 4) & 0x430c30c3u;
    return (x | x << 2) & 0x49249249u;
}

// The upper 32 of the 33 bits of a cell's place along the curve. After J. Skilling, Programming the
// Hilbert curve, AIP Conference Proceedings 707 (2004): the curve of each octant of a cube is the
// cube's, exchanged and mirrored, from the largest octants to the smallest; then Gray code.
SHARED_FN uint light_order_key(uint x, uint y, uint z) {
    for (uint bit = LIGHT_CELL_BIT; bit > 1u; bit >>= 1) {
        uint below = bit - 1u;
        x ^= (x & bit) != 0u ? below : 0u;
        uint swapped = (y & bit) != 0u ? 0u : (x ^ y) & below;
        x ^= (y & bit) != 0u ? below : swapped;
        y ^= swapped;
        swapped = (z & bit) != 0u ? 0u : (x ^ z) & below;
        x ^= (z & bit) != 0u ? below : swapped;
        z ^= swapped;
    }
    y ^= x;
    z ^= y;
    uint flip = 0u;
    for (uint bit = LIGHT_CELL_BIT; bit > 1u; bit >>= 1) flip ^= (z & bit) != 0u ? bit - 1u : 0u;
    return spread_bits(x ^ flip) << 1 | spread_bits(y ^ flip) | spread_bits(z ^ flip) >> 1;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
