// SPDX-License-Identifier: Apache-2.0
// The G-buffer as shading sees it, in float planes: for AOVs, views and the float64 references.
// One work-item decodes VW neighbouring pixels of a row.
#include "kernels/device/lit_item.h"
#include "kernels/shared/gbuffer.h"

// Where the decoded pixels go.
typedef struct SurfacePlanes {
    global float* planes;
    uint plane_size;  // [float]
    uint first;       // place of the pixels in a plane
    MASK shown;       // other pixels become 0
} SurfacePlanes;

static inline void store_scalar(SurfacePlanes to, uint plane, FV value) {
    lane_store(lane_select(to.shown, value, fv(0.0f)),
               to.planes + plane * to.plane_size + to.first);
}

static inline void store_vector(SurfacePlanes to, uint first_plane, FV3 value) {
    store_scalar(to, first_plane, value.x);
    store_scalar(to, first_plane + 1, value.y);
    store_scalar(to, first_plane + 2, value.z);
}

kernel void decode_gbuffer(GBUFFER_ARGS,
                           // out [SURFACE_PLANES][height][stride]; 0 for background
                           global float* restrict planes) {
    BEGIN_ROW;
    SurfacePlanes to = {planes, view.stride * view.height, item.pixels.first, item.shown};
    Surface s = load_surface(g, item.pixels, item.z);
    store_scalar(to, SURFACE_DEPTH, item.z);
    store_vector(to, SURFACE_POSITION, s.position);
    store_vector(to, SURFACE_NORMAL, s.normal);
#define DECODE_VECTOR(has, member, decoded, plane, value) store_vector(to, decoded, s.member);
#define DECODE_SCALAR(has, member, decoded, plane, value) store_scalar(to, decoded, s.member);
    SURFACE_VALUES(DECODE_VECTOR, DECODE_SCALAR)
}
