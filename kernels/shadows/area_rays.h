// SPDX-License-Identifier: Apache-2.0
// Packs the rays of a cluster's pixels to one light, from all its slots. Few pixels pick a lobe, so
// unpacked rows would be mostly empty. One walk serves all packed rays.
#ifndef KILOLUX_DEVICE_AREA_RAYS_H
#define KILOLUX_DEVICE_AREA_RAYS_H
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_cast.h"

#if AREA_SHADOWS
#define NO_PLACE 0xffffu

typedef struct AreaRays {
    ShadowPoints ends;             // a row has rays of one lobe
    uint slots[SHADOW_POINTS];     // of the light
    ushort places[SHADOW_POINTS];  // of pixels in the tile's order; NO_PLACE: the lane has no ray
    uint count;
} AreaRays;

// The words of a light's slots at a cluster's pixels.
typedef struct SlotWords {
    global uint* words;
    uint count;  // of each slot
    uint first;  // place of bit 0 of word 0
} SlotWords;

// A ray of the pixel at a place.
static inline void add_ray(AreaRays* rays, const ShadowPoints* from, uint place, uint slot) {
    copy_point(&rays->ends, rays->count, from, place);
    rays->slots[rays->count] = slot;
    rays->places[rays->count++] = (ushort)place;
}

// Fills the last row.
static inline void end_lobe(AreaRays* rays, const ShadowPoints* from) {
    while (rays->count % VW != 0u) {
        uint last = rays->count - 1u;
        add_ray(rays, from, 0u, rays->slots[last]);
        rays->places[last + 1u] = NO_PLACE;
    }
}

// Finds the ends of a row's rays; the lit ones grow the boxes.
static inline MASK begin_row(AreaRays* rays, uint row, ShadowScene scene, ShadowLight light,
                             float rays_of_pixel, LaneBox* origins, LaneBox* targets) {
    uint at = row * VW;
    UV slots = lane_load(rays->slots + at);
    uint lobe = rays->slots[at] / lobe_slots(rays_of_pixel);
    light.area = at_slots(light.area, lobe, slots, rays_of_pixel);
    uint bits = 0u;
    for (uint i = 0; i < VW; ++i) bits |= rays->places[at + i] != NO_PLACE ? 1u << i : 0u;
    MASK wanted = lane_mask(((UV)(bits) >> lane_numbers & 1u) != (UV)(0u));
    MASK lit = face_light(scene.view, &rays->ends, row, light, wanted);
    *origins = grown_box(*origins, lit, load_points(&rays->ends, row));
    *targets = grown_box(*targets, lit, load_ray_ends(&rays->ends, row));
    return lit;
}

// Clears the bits of rays that nothing hides; the number of such rays.
static inline uint put_seen(const AreaRays* rays, SlotWords to) {
    uint seen = 0;
    for (uint i = 0; i < rays->count; ++i) {
        uint place = rays->places[i];
        if (place == NO_PLACE || as_int(rays->ends.lit[i]) == 0) continue;
        to.words[rays->slots[i] * to.count + (place - to.first) / 32u] &= ~(1u << place % 32u);
        ++seen;
    }
    return seen;
}

// Casts the rays, and forgets them.
static inline void cast_rays(ShadowScene scene, ShadowLight light, float rays_of_pixel,
                             SlotWords to, AreaRays* rays) {
    LaneBox origins = no_box(), targets = no_box();
    MASK any = (MASK)(0);
    uint lit_count = 0;
    ulong tests_before = counted_tests(&rays->ends);
    for (uint row = 0; row < rays->count / VW; ++row) {
        MASK lit = begin_row(rays, row, scene, light, rays_of_pixel, &origins, &targets);
        any |= lit;
        lit_count += lane_count(lit);
    }
    if (lane_any(any)) {
        light.area.low = box_low(targets);
        light.area.high = box_high(targets);
        cast_shadows_of(scene, light, box_low(origins), box_high(origins), 0u, rays->count / VW,
                        &rays->ends);
        count_rays(&rays->ends, tests_before, lit_count, put_seen(rays, to));
    }
    rays->count = 0u;
}

// The bits of all slots of a light. points: of the tile.
static inline void cast_area_light(ShadowScene scene, ShadowLight light, CastLights from,
                                   SlotWords to, const ShadowPoints* points, AreaRays* rays) {
    rays->count = 0u;
    for (uint slot = 0; slot < light_ray_slots(from.rays);) {
        global const uint* words = to.words + slot * to.count;
        uint any = 0u;
        for (uint i = 0; i < to.count; ++i) {
            any |= words[i];
            for (uint bits = words[i]; bits != 0u; bits &= bits - 1u) {
                add_ray(rays, points, to.first + i * 32u + lowest_bit(bits), slot);
                if (rays->count == SHADOW_POINTS) cast_rays(scene, light, from.rays, to, rays);
            }
        }
        uint next = next_lobe(from, slot);
        slot = any == 0u ? next : slot + 1u;
        if (slot == next) end_lobe(rays, points);
        if (rays->count == SHADOW_POINTS) cast_rays(scene, light, from.rays, to, rays);
    }
    if (rays->count > 0u) cast_rays(scene, light, from.rays, to, rays);
}
#endif
#endif
