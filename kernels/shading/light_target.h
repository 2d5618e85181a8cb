// SPDX-License-Identifier: Apache-2.0
// Stores a pixel's light: as three planes of radiance or, with DISPLAYED, as codes of a display.
#ifndef KILOLUX_DEVICE_LIGHT_TARGET_H
#define KILOLUX_DEVICE_LIGHT_TARGET_H
#include "kernels/device/display.h"
#include "kernels/device/gbuffer.h"
#include "kernels/device/radiance.h"

#ifndef DISPLAYED
#define DISPLAYED 0
#endif

typedef struct LightTarget {
#if DISPLAYED
    global uint* codes;  // [height][stride]
    DisplayCurve curve;
#else
    global float* radiance;  // [3][height][stride]
#endif
} LightTarget;

#if DISPLAYED
#define LIGHT_TARGET_OF_ARGS ((LightTarget){display, {gain, SRGB_TABLE_OF_ARGS}})
#else
#define LIGHT_TARGET_OF_ARGS ((LightTarget){radiance})
#endif

static inline void store_light(LightTarget to, View view, Pixels pixels, FV3 color) {
#if DISPLAYED
    store_plane_codes(to.codes, pixels, display_codes(to.curve, color));
#else
    store_radiance(to.radiance, view, pixels, color);
#endif
}

// Light of a group, 1 .. LIGHT_GROUPS.
static inline void store_group_light(LightTarget to, View view, uint group, Pixels pixels,
                                     FV3 color) {
#if LIGHT_GROUPS
    store_radiance(to.radiance + group_planes(view, group), view, pixels, color);
#endif
}

static inline void store_darkness(LightTarget to, View view, Pixels pixels) {
    store_light(to, view, pixels, zero3());
    for (uint i = 1u; i <= LIGHT_GROUPS; ++i) store_group_light(to, view, i, pixels, zero3());
}

// Prefetches the row's pixels in the tile to the right, which a CPU's thread shades next.
static inline void prefetch_next_tile(GBuffer g, LightTarget to, uint x, uint y) {
    uint place = y * g.view.stride + x + FINE_TILE;
    prefetch_surface(g, place);
#if DISPLAYED
    prefetch_to_write(to.codes + place);
#else
    uint plane = g.view.stride * g.view.height;
    for (uint i = 0; i < 3u + 3u * LIGHT_GROUPS; ++i) {
        prefetch_to_write(to.radiance + i * plane + place);
    }
#endif
}
#endif
