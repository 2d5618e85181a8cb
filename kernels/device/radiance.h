// SPDX-License-Identifier: Apache-2.0
// Stores the result of shading: three planes, and three more for each group of lights.
#ifndef KILOLUX_DEVICE_RADIANCE_H
#define KILOLUX_DEVICE_RADIANCE_H
#include "kernels/device/gbuffer.h"
#include "kernels/device/lanes.h"

// Groups of lights whose light is stored, each for itself, beside the whole: RADIANCE_PLANES is
// [3 + 3 * LIGHT_GROUPS][height][stride].
#ifndef LIGHT_GROUPS
#define LIGHT_GROUPS 0
#endif

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

static inline void store_plane_codes(global uint* plane, Pixels pixels, UV value) {
#if ORDERED_PIXELS
    if (!pixels.in_row) {
        uint lanes[VW];
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

// The first of a group's planes; group 0 is the whole.
static inline uint group_planes(View view, uint group) {
    return 3u * group * view.stride * view.height;
}

static inline FV3 load_radiance(global const float* radiance, View view, Pixels pixels) {
    uint plane = view.stride * view.height;
    return fv3(LOAD_PLANE(FV, radiance, pixels), LOAD_PLANE(FV, radiance + plane, pixels),
               LOAD_PLANE(FV, radiance + 2 * plane, pixels));
}
#endif
