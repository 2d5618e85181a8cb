// SPDX-License-Identifier: Apache-2.0
// The places of cast_shadows' bits.
#ifndef KILOLUX_DEVICE_SHADOW_BITS_H
#define KILOLUX_DEVICE_SHADOW_BITS_H
#include "kernels/device/lanes.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/light_extras.h"
#include "kernels/shared/shadow.h"

#define AREA_LOBES AREA_LOBES_OF(SHADING)
// Slots of a light of a list: for its rays, and all.
#if HAS_AREA_LIGHTS
#define light_ray_slots(rays) (AREA_LOBES * lobe_slots(rays))
#define light_slots(rays) slots_of_light(AREA_LOBES, rays)
#else
#define light_ray_slots(rays) 1u
#define light_slots(rays) 1u
#endif

// Whether a tile has words, and there is room for the words of all tiles; else the host makes room
// and repeats the frame. Offsets are modulo 2^32: of more words some tiles may have room, and the
// host refuses the frame.
static inline bool has_usable_words(global const uint* offsets, uint capacity, uint tile,
                                    uint tiles) {
    uint begin = offsets[tile], end = offsets[tile + 1];
    return begin < end && end <= capacity && offsets[tiles] <= capacity;
}
// In a kernel with WORD_ARGS and a view.
#define HAS_USABLE_WORDS(tile) \
    has_usable_words(word_offsets, word_capacity, tile, fine_tile_count(view))

// Words for each light of a cluster whose pixels are first .. end - 1 in the tile's order.
static inline uint shadow_words(uint first, uint end) { return (end + 31u) / 32u - first / 32u; }

// One work-item's bits of a cluster: word i * stride is that of the cluster's i-th light.
typedef struct ShadowBits {
    global const uint* words;
    uint stride;
    uint shift;  // bit of lane 0
} ShadowBits;

// The bits of a work-item whose first pixel has `place` in its tile's order, and which has some of
// the cluster's pixels. `tile_words`: of its tile.
static inline ShadowBits bits_of_cluster(global const uint* tile_words,
                                         global const ActiveCluster* c, uint place) {
    ShadowBits out;
    out.words = tile_words + c->first_word + (place / 32u - c->first_pixel / 32u);
    out.stride = shadow_words(c->first_pixel, c->first_pixel + c->pixel_count);
    out.shift = place % 32u;
    return out;
}

// Sets bits.
static inline void put_bits(ShadowBits bits, uint i, MASK lanes, global uint* words) {
    if (!lane_any(lanes)) return;
    atomic_or(words + (bits.words - words) + i * bits.stride, lane_ballot(lanes) << bits.shift);
}

// A word from the bit of lane 0 on.
static inline uint word_of_lanes(ShadowBits bits, uint i) {
    return bits.words[i * bits.stride] >> bits.shift;
}

// The lanes that see the cluster's i-th light, directional ones first.
static inline MASK sees_light(ShadowBits bits, uint i) {
    UV mine = (UV)(word_of_lanes(bits, i)) >> lane_numbers & 1u;
    return lane_mask(mine != (UV)(0u));
}
#endif
