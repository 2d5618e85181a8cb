// SPDX-License-Identifier: Apache-2.0
// Lists tiles with the most entries first: where groups begin in this order, the last ones, which
// few others run beside, are short. One work-group of GROUP items; the order within a class is that
// in which items come.

// Classes of tiles by their number of entries, two an octave; the last one has none.
#define CLASSES 65
static inline uint class_of_tile(global const uint* offsets, uint tile) {
    uint entries = offsets[tile + 1] - offsets[tile];
    if (entries == 0u) return CLASSES - 1u;
    uint octave = 31u - clz(entries);
    uint upper = octave == 0u ? 0u : entries >> (octave - 1u) & 1u;
    return CLASSES - 2u - 2u * octave - upper;
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void order_tiles(
    uint tile_count,
    global const uint* restrict offsets,  // [tile_count + 1]
    global uint* restrict tiles) {        // out [tile_count]
    local uint places[CLASSES];           // the next one of each
    uint item = get_local_id(0);
    for (uint i = item; i < CLASSES; i += GROUP) places[i] = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);  // 0 before any adds to it
    for (uint tile = item; tile < tile_count; tile += GROUP) {
        atomic_inc(&places[class_of_tile(offsets, tile)]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // all are counted
    if (item == 0u) {
        uint first = 0u;
        for (uint i = 0; i < CLASSES; ++i) {
            uint count = places[i];
            places[i] = first;
            first += count;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // each class has its first place
    for (uint tile = item; tile < tile_count; tile += GROUP) {
        tiles[atomic_inc(&places[class_of_tile(offsets, tile)])] = tile;
    }
}
