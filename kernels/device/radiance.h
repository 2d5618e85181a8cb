// SPDX-License-Identifier: Apache-2.0
// Where shading stores its result: three planes.
#ifndef KILOLUX_DEVICE_RADIANCE_H
#define KILOLUX_DEVICE_RADIANCE_H
#include "kernels/device/gbuffer.h"
#include "kernels/device/lanes.h"

static inline void store_plane(global float* plane, Pixels pixels, FV value) {
#if ORDERED_PIXELS
    if (!pixels.in_row) {
        float lanes[VW];
        lane_store(value, lanes);
        for (uint i = 0; i < VW; ++i) plane[pixels.place[i]] = lanes[i];
        return;
    }
#endif
    lane_store(value, plane + pixels.first);
}

static inline void store_radiance(global float* radiance, View view, Pixels pixels, FV3 color) {
    uint plane = view.stride * view.height;
    store_plane(radiance, pixels, color.x);
    store_plane(radiance + plane, pixels, color.y);
    store_plane(radiance + 2 * plane, pixels, color.z);
}

static inline FV3 load_radiance(global const float* radiance, View view, Pixels pixels) {
    uint plane = view.stride * view.height;
    return fv3(LOAD_PLANE(FV, radiance, pixels), LOAD_PLANE(FV, radiance + plane, pixels),
               LOAD_PLANE(FV, radiance + 2 * plane, pixels));
}

// Asks for the row's pixels in the tile to the right, which a CPU's thread shades next.
static inline void prefetch_next_tile(GBuffer g, global float* radiance, uint x, uint y) {
    uint place = y * g.view.stride + x + FINE_TILE;
    uint plane = g.view.stride * g.view.height;
    prefetch_surface(g, place);
    prefetch_to_write(radiance + place);
    prefetch_to_write(radiance + plane + place);
    prefetch_to_write(radiance + 2 * plane + place);
}
#endif
