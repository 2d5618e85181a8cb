// SPDX-License-Identifier: Apache-2.0
// The order in which kernels go through lights: along a Morton curve (Morton 1966) within cubes of
// 32 cells along an edge.
#ifndef KILOLUX_SHARED_LIGHTS_LIGHT_ORDER_H
#define KILOLUX_SHARED_LIGHTS_LIGHT_ORDER_H
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// Cell numbers have either sign, and a key keeps 11 bits of them: cubes 64 apart share keys. Lights
// farther than this from the origin, or with a NaN, are in cell LIGHT_CELL_FAR along that axis.
#define LIGHT_CELLS 16777216.0f
#define LIGHT_CELL_FAR 0xffffffffu

// The six lower bits, two zeros between each.
SHARED_FN uint spread_bits(uint x) {
    x = x & 0x3fu;
    x = (x | x << 8) & 0x300fu;
    x = (x | x << 4) & 0x30c3u;
    return (x | x << 2) & 0x9249u;
}

SHARED_FN uint morton_code(uint x, uint y, uint z) {
    return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

SHARED_FN uint reversed_bits(uint x) {
    x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
    return x << 16 | x >> 16;
}

// A cell's place in the order. First 18 bits of the cube, reversed, so that neighbouring cubes are
// far from each other: lights near the camera cost more than others, and consecutive ones are
// culled by one work-group. Then the cell in the cube but for its last bit.
SHARED_FN uint light_order_key(uint x, uint y, uint z) {
    uint cube = morton_code(x >> 5, y >> 5, z >> 5);
    uint cell = morton_code(x & 31u, y & 31u, z & 31u);
    return (reversed_bits(cube) & 0xffffc000u) | cell >> 1;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
