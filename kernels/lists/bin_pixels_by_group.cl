// SPDX-License-Identifier: Apache-2.0
// bin_pixels by a work-group a tile: all slices and strips at once, in local memory. For GPUs.
#include "kernels/lists/bin_pixels.h"

#ifndef GROUP
#define GROUP 64
#endif

// Strips that one work-item takes: number round * GROUP + its own.
#define ROUNDS ((FINE_TILE * STRIPS + GROUP - 1) / GROUP)
// Words of a bit for each slice: make_cluster_grid() has at most 64 an octave, and 200 octaves.
#define SLICE_WORDS (64 * 256 / 32)
// Words of a bit for each pixel of a tile.
#define PIXEL_WORDS (FINE_TILE_PIXELS / 32)
// Clusters that a tile fills at once: few tiles have more, and groups need little local memory, so
// that a device holds many of them.
#define AT_ONCE 32

static inline uint strip_of_round(uint round) { return round * GROUP + (uint)get_local_id(0); }

static inline uint slice_words(ClusterGrid grid) {
    return ((grid.slices << grid.fine_slice_bits) + 31u) / 32u;
}

// The bits below bit i of a word.
static inline uint bits_below(uint word, uint i) { return word & ((1u << i) - 1u); }

// The slices of a work-item's strips, and a bit in `seen` for each slice of the tile.
static inline void load_slices(GBuffer g, ClusterGrid grid, uint tile_x, uint tile_y, UV* slices,
                               local uint* seen) {
    for (uint i = get_local_id(0); i < slice_words(grid); i += GROUP) seen[i] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);  // cleared before any bit is set
    uint strips = rows_of_tile(g.view, tile_y) * STRIPS;
    uint last = NO_SLICE;  // the slice whose bit the work-item set last
    for (uint round = 0; round < ROUNDS; ++round) {
        uint strip = strip_of_round(round);
        slices[round] = (UV)(NO_SLICE);
        FV z;
        if (strip < strips) {
            Pixels pixels = strip_pixels(g.view, tile_x, tile_y, strip);
            slices[round] = slices_of_pixels(g, grid, pixels, &z);
        }
        uint slice[VW];
        lane_store(slices[round], slice);
        for (uint lane = 0; lane < VW; ++lane) {
            if (slice[lane] == last) continue;
            last = slice[lane];
            if (last != NO_SLICE) atomic_or(&seen[last / 32], 1u << last % 32);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // all bits are set
}

// How many of the tile's slices lie below `slice`.
static inline uint cluster_of(local const uint* seen, uint slice) {
    uint cluster = 0;
    for (uint word = 0; word < slice / 32; ++word) cluster += popcount(seen[word]);
    return cluster + popcount(bits_below(seen[slice / 32], slice % 32));
}

static inline uint count_slices(local const uint* seen, ClusterGrid grid) {
    uint count = 0;
    for (uint word = 0; word < slice_words(grid); ++word) count += popcount(seen[word]);
    return count;
}

kernel void bin_pixels_count(GBUFFER_ARGS, ClusterGrid grid,
                             global uint* restrict counts,  // out [tiles]: active clusters
                             // Of coarse clusters: 1 where one has active ones. In: 0; concurrent
                             // writers write the same value.
                             global uchar* restrict occupied) {  // [cluster_count]
    local uint seen[SLICE_WORDS];
    uint tiles_x = fine_tiles_x(view);
    uint tile = get_group_id(0);
    GBuffer g = GBUFFER_OF_ARGS;
    UV slices[ROUNDS];
    load_slices(g, grid, tile % tiles_x, tile / tiles_x, slices, seen);
    if (get_local_id(0) == 0) counts[tile] = count_slices(seen, grid);
    CoarseTile coarse = coarse_tile(view, grid, tile);
    uint fine_slices = grid.slices << grid.fine_slice_bits;
    for (uint slice = get_local_id(0); slice < fine_slices; slice += GROUP) {
        if (seen[slice / 32] >> slice % 32 & 1u)
            occupied[cluster_index(grid, coarse.column, coarse.row,
                                   slice >> grid.fine_slice_bits)] = 1;
    }
}

// Some clusters of a tile while they are built, from number `begin` on; background is the last one.
typedef struct TileClusters {
    int low[AT_ONCE][3];  // of the boxes, as ordered_bits
    int high[AT_ONCE][3];
    uint pixels[AT_ONCE][PIXEL_WORDS];  // a bit for each pixel of a cluster
    uint first[AT_ONCE];                // where their pixels begin in the tile's order
    uint slice[AT_ONCE];
    uint end;  // where the pixels of the next clusters begin
} TileClusters;

// Floats' order, negative ones included, as integers'; its own inverse on bits.
static inline int ordered_bits(int bits) { return bits ^ (bits >> 31 & 0x7fffffff); }

// count: of the clusters, background included.
static inline void clear_clusters(local TileClusters* tile, uint count) {
    for (uint i = get_local_id(0); i < count; i += GROUP) {
        for (uint word = 0; word < PIXEL_WORDS; ++word) tile->pixels[i][word] = 0;
        for (uint axis = 0; axis < 3; ++axis) {
            tile->low[i][axis] = ordered_bits(as_int(Z_UNBOUNDED));
            tile->high[i][axis] = ordered_bits(as_int(-Z_UNBOUNDED));
        }
    }
}

// A run of one work-item's pixels in the same cluster. Its box is merged locally first, so few
// atomics contend.
typedef struct Run {
    uint cluster;  // NO_CLUSTER: none yet
    float low[3], high[3];
} Run;

#define NO_CLUSTER 0xffffffffu

static inline void end_run(Run run, local TileClusters* tile) {
    if (run.cluster == NO_CLUSTER) return;
    for (uint axis = 0; axis < 3; ++axis) {
        atomic_min(&tile->low[run.cluster][axis], ordered_bits(as_int(run.low[axis])));
        atomic_max(&tile->high[run.cluster][axis], ordered_bits(as_int(run.high[axis])));
    }
}

// Ends the runs of all items. They join in pairs first: where a tile is one cluster, one is left.
// runs: [GROUP].
static inline void end_runs(Run run, local Run* runs, local TileClusters* tile) {
    uint item = get_local_id(0);
    runs[item] = run;
    for (uint count = GROUP, step; count > 1u; count = step) {
        step = (count + 1u) / 2u;
        barrier(CLK_LOCAL_MEM_FENCE);  // all that the step before joined is there
        if (item + step < count) {
            Run mine = runs[item], other = runs[item + step];
            if (mine.cluster == other.cluster) {
                for (uint axis = 0; axis < 3; ++axis) {
                    mine.low[axis] = min(mine.low[axis], other.low[axis]);
                    mine.high[axis] = max(mine.high[axis], other.high[axis]);
                }
                runs[item] = mine;
            } else {
                end_run(other, tile);
            }
        }
    }
    if (item == 0u) end_run(runs[0], tile);
}

static inline Run add_to_run(Run run, uint cluster, const float* position,
                             local TileClusters* tile) {
    bool goes_on = run.cluster == cluster;
    if (!goes_on) end_run(run, tile);
    run.cluster = cluster;
    for (uint axis = 0; axis < 3; ++axis) {
        float at = position[axis];
        run.low[axis] = goes_on ? min(run.low[axis], at) : at;
        run.high[axis] = goes_on ? max(run.high[axis], at) : at;
    }
    return run;
}

// A strip that a work-item has.
typedef struct Strip {
    uint pixel;  // the first one of the tile's
    uint slice[VW];
    uint number[VW];  // of the pixels' clusters; of background pixels the tile's count
} Strip;

static inline Strip numbered_strip(uint pixel, UV slices, local const uint* seen, uint count) {
    Strip strip;
    strip.pixel = pixel;
    lane_store(slices, strip.slice);
    for (uint i = 0; i < VW; ++i) {
        uint slice = strip.slice[i];
        strip.number[i] = i > 0u && slice == strip.slice[i - 1u] ? strip.number[i - 1u]
                          : slice == NO_SLICE                    ? count
                                                                 : cluster_of(seen, slice);
    }
    return strip;
}

// A strip's pixels join those of their clusters that are at hand.
static inline Run add_strip(Run run, GBuffer g, Pixels at, const Strip* strip, uint begin,
                            local TileClusters* tile) {
    FV3 p = load_position(g, at, view_depth(g.view, at.x, at.y, load_depth01(g, at)));
    float x[VW], y[VW], z[VW];
    lane_store(p.x, x);
    lane_store(p.y, y);
    lane_store(p.z, z);
    uint bits = 0u;  // of neighbours in one cluster
    for (uint i = 0; i < VW; ++i) {
        uint cluster = strip->number[i] - begin;
        if (cluster >= AT_ONCE) continue;
        bits |= 1u << (strip->pixel % 32 + i);
        if (i + 1u == VW || strip->number[i + 1u] != strip->number[i]) {
            atomic_or(&tile->pixels[cluster][strip->pixel / 32], bits);
            bits = 0u;
        }
        if (strip->slice[i] == NO_SLICE) continue;
        if (run.cluster != cluster) tile->slice[cluster] = strip->slice[i];
        float position[3] = {x[i], y[i], z[i]};
        run = add_to_run(run, cluster, position, tile);
    }
    return run;
}

static inline uint pixels_of(local const uint* words) {
    uint sum = 0;
    for (uint word = 0; word < PIXEL_WORDS; ++word) sum += popcount(words[word]);
    return sum;
}

// Where the pixels of each cluster begin, by one work-item.
static inline void place_clusters(local TileClusters* tile, uint count) {
    for (uint i = 0; i < count; ++i) {
        tile->first[i] = tile->end;
        tile->end += pixels_of(tile->pixels[i]);
    }
}

static inline ActiveCluster finished_cluster(local const TileClusters* tile, uint i) {
    ActiveCluster c;
    c.min_x = as_float(ordered_bits(tile->low[i][0]));
    c.min_y = as_float(ordered_bits(tile->low[i][1]));
    c.min_z = as_float(ordered_bits(tile->low[i][2]));
    c.max_x = as_float(ordered_bits(tile->high[i][0]));
    c.max_y = as_float(ordered_bits(tile->high[i][1]));
    c.max_z = as_float(ordered_bits(tile->high[i][2]));
    c.slice = tile->slice[i];
    c.pixel_count = pixels_of(tile->pixels[i]);
    c.list_begin = 0;
    c.list_count = 0;
    c.first_pixel = 0;
    c.first_word = 0;
    return c;
}

// Puts those of a strip's pixels whose clusters are at hand at their places in the tile's order.
static inline void place_strip(const Strip* strip, uint begin, local const TileClusters* tile,
                               global uchar* order) {
    uint pixel = strip->pixel;
    for (uint lane = 0; lane < VW; ++lane) {
        uint cluster = strip->number[lane] - begin;
        if (cluster >= AT_ONCE) continue;
        uint place = tile->first[cluster];
        for (uint word = 0; word < pixel / 32; ++word)
            place += popcount(tile->pixels[cluster][word]);
        place += popcount(bits_below(tile->pixels[cluster][pixel / 32], pixel % 32 + lane));
        order[place] = (uchar)(pixel + lane);
    }
}

kernel void bin_pixels_fill(GBUFFER_ARGS, CLUSTER_ARGS()) {  // out: clusters and order
    local uint seen[SLICE_WORDS];
    local TileClusters made;
    local Run runs[GROUP];
    uint tiles_x = fine_tiles_x(view);
    uint tile = get_group_id(0);
    uint tile_x = tile % tiles_x;
    uint tile_y = tile / tiles_x;
    uint count = cluster_offsets[tile + 1] - cluster_offsets[tile];
    GBuffer g = GBUFFER_OF_ARGS;
    UV slices[ROUNDS];
    load_slices(g, grid, tile_x, tile_y, slices, seen);
    uint end = rows_of_tile(view, tile_y) * STRIPS;
    Strip strips[ROUNDS];
    for (uint round = 0; round < ROUNDS; ++round) {
        strips[round] = numbered_strip(strip_of_round(round) * VW, slices[round], seen, count);
    }
    if (get_local_id(0) == 0) made.end = 0u;
    for (uint begin = 0; begin <= count; begin += AT_ONCE) {
        uint here = min(count + 1u - begin, (uint)AT_ONCE);  // with background
        clear_clusters(&made, here);
        barrier(CLK_LOCAL_MEM_FENCE);  // cleared before any grows
        Run run = {NO_CLUSTER, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
        for (uint round = 0; round < ROUNDS; ++round) {
            uint strip = strip_of_round(round);
            if (strip < end)
                run = add_strip(run, g, strip_pixels(view, tile_x, tile_y, strip), &strips[round],
                                begin, &made);
        }
        end_runs(run, runs, &made);
        barrier(CLK_LOCAL_MEM_FENCE);  // all pixels have joined
        if (get_local_id(0) == 0) place_clusters(&made, here);
        barrier(CLK_LOCAL_MEM_FENCE);  // placed before any is written
        for (uint i = begin + (uint)get_local_id(0); i < min(count, begin + AT_ONCE); i += GROUP) {
            if (cluster_offsets[tile] + i < cluster_capacity)
                clusters[cluster_offsets[tile] + i] = finished_cluster(&made, i - begin);
        }
        for (uint round = 0; round < ROUNDS; ++round) {
            if (strip_of_round(round) < end)
                place_strip(&strips[round], begin, &made, order + tile * FINE_TILE_PIXELS);
        }
        barrier(CLK_LOCAL_MEM_FENCE);  // all are written before the next ones are cleared
    }
}
