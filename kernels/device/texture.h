// SPDX-License-Identifier: Apache-2.0
// The texel table in OpenCL C, for the filters of kernels/shared/texture.h.
#ifndef KILOLUX_DEVICE_TEXTURE_H
#define KILOLUX_DEVICE_TEXTURE_H
#include "kernels/device/lanes.h"
#include "kernels/device/prefetch.h"
#include "kernels/shared/surface_scene.h"

typedef struct TextureBuffers {
    global const TextureRow* rows;
    global const ulong* texels;  // 16 bits a channel, linear, red lowest
} TextureBuffers;

// The texture that a use of a material reads.
typedef struct Map {
    global const TextureRow* row;
    global const ulong* texels;
} Map;

static inline Map make_map(TextureBuffers buffers, uint texture, uint use) {
    Map map;
    map.row = buffers.rows + texture;
    map.texels = buffers.texels + map.row->first_texel;
    return map;
}

#define TEXTURE_ROW(map) (*(map).row)

static inline UV level_offsets(Map map, UV level) {
    global const uint* offsets = map.row->level_offset;
#if VW == 1
    return offsets[level];
#else
    uint levels[VW];
    lane_store(level, levels);
    return lane_gather(UV, offsets, levels);
#endif
}

// Loads pairs of words one by one: compilers would make a gather of single elements, which CPUs run
// slower (Zen 4: half as fast).
static inline Texels gather_texels(global const ulong* texels, UV place) {
    Texels out;
    global const uint2* pairs = (global const uint2*)texels;
#if VW == 1
    uint2 all = pairs[place];
    out.low = all.x;
    out.high = all.y;
#else
    uint at[VW];
    lane_store(place, at);
#if VW == 2
    uint4 all = (uint4)(pairs[at[0]], pairs[at[1]]);
#elif VW == 4
    uint8 all = (uint8)(pairs[at[0]], pairs[at[1]], pairs[at[2]], pairs[at[3]]);
#else
    uint16 all = (uint16)(pairs[at[0]], pairs[at[1]], pairs[at[2]], pairs[at[3]], pairs[at[4]],
                          pairs[at[5]], pairs[at[6]], pairs[at[7]]);
#endif
#if VW == 16
    uint16 rest = (uint16)(pairs[at[8]], pairs[at[9]], pairs[at[10]], pairs[at[11]], pairs[at[12]],
                           pairs[at[13]], pairs[at[14]], pairs[at[15]]);
    out.low = (uint16)(all.even, rest.even);
    out.high = (uint16)(all.odd, rest.odd);
#else
    out.low = all.even;
    out.high = all.odd;
#endif
#endif
    return out;
}

static inline Texels fetch_texels(Map map, UV place) { return gather_texels(map.texels, place); }

#include "kernels/shared/texture.h"

// Prefetches the texels of a level.
static inline void prefetch_level(global const ulong* texels, const LevelLookup* at) {
#if PREFETCH && VW > 1
    uint upper[VW];
    uint lower[VW];
    lane_store(at->upper_left, upper);
    lane_store(at->lower_left, lower);
#pragma unroll
    for (uint i = 0; i < VW; ++i) {
        prefetch_to_read(texels + upper[i]);
        prefetch_to_read(texels + lower[i]);
    }
#endif
}

static inline void prefetch_map(Map map, const Lookup* at) {
    prefetch_level(map.texels, &at->level);
    if (at->two_levels) prefetch_level(map.texels, &at->coarser);
}
#endif
