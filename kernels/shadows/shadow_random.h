// SPDX-License-Identifier: Apache-2.0
// Random numbers of sampled shadows: hashes of the seed, of the fine tile or pixel of the picture,
// and of the light, so that all kernels have the same.
#ifndef KILOLUX_DEVICE_SHADOW_RANDOM_H
#define KILOLUX_DEVICE_SHADOW_RANDOM_H
#include "kernels/device/pixels.h"
#include "kernels/shared/hash.h"

// Of the seed and the fine tile with the pixel (x, y) of the planes.
static inline uint tile_key(View view, uint seed, uint x, uint y) {
    uint tile_x = picture_column(view, x) / FINE_TILE;
    uint tile_y = picture_row(view, y) / FINE_TILE;
    return hash_of(hash_of(hash_of(seed) ^ tile_x) ^ tile_y);
}

// Of a light in a tile.
static inline uint light_key(uint tile, uint light) { return hash_of(light ^ tile); }

// Of the rays of one of its lobes.
static inline uint lobe_key(uint light, uint lobe) {
    return lobe == 0u ? light : hash_of(light ^ 0x9e3779b9u);
}

static inline UV lane_hash(UV x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

// Of a pixel of the picture.
static inline UV pixel_key(Pixels pixels) {
    return lane_hash(lane_to_uint(pixels.x) | lane_to_uint(pixels.y) << 16);
}

// In [0, 1), in steps of 2^-24.
static inline FV lane_random_of(UV hash) { return lane_to_float(hash >> 8) * fv(1.0f / (1 << 24)); }

// Three random numbers as fractions of 2^32.
typedef struct LaneFractions {
    UV u, v, w;
} LaneFractions;

// The numbers of attempt `attempt` of the ray of a lobe's slot `slot` to a light. Slots 0, 2, ...
// and 1, 3, ... are two independent sets, and so are attempts. In each the numbers are a lattice
// that a random shift moves: its points spread evenly, and each alone is uniform (Roberts 2018,
// "The Unreasonable Effectiveness of Quasirandom Sequences": powers of the root of x^4 = x + 1).
static inline LaneFractions ray_fractions(uint key, UV pixel, UV slot, uint attempt) {
    UV set = lane_hash(lane_hash((slot & 1u) + (key + 1u)) + attempt);
    UV i = slot >> 1;
    LaneFractions out;
    out.u = pixel + (lane_hash(set + 1u) + i * 0xd1b54a33u);
    out.v = lane_hash(pixel + 1u) + (lane_hash(set + 2u) + i * 0xabc98389u);
    out.w = lane_hash(pixel + 2u) + (lane_hash(set + 3u) + i * 0x8cb92ba7u);
    return out;
}
#endif
