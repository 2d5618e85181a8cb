// SPDX-License-Identifier: Apache-2.0
// The G-buffer as shading sees it, in float planes: for AOVs, views and the float64 references.
// One work-item decodes VW neighbouring pixels of a row.
#include "kernels/device/gbuffer.h"
#include "kernels/shared/surface_planes.h"

// Where the decoded pixels go.
typedef struct SurfacePlanes {
    global float* planes;
    uint plane_size;  // [float]
    uint first;       // place of the pixels in a plane
    MASK drawn;       // other pixels become 0
} SurfacePlanes;

static inline void store_scalar(SurfacePlanes to, uint plane, FV value) {
    lane_store(lane_select(to.drawn, value, fv(0.0f)),
               to.planes + plane * to.plane_size + to.first);
}

static inline void store_vector(SurfacePlanes to, uint first_plane, FV3 value) {
    store_scalar(to, first_plane, value.x);
    store_scalar(to, first_plane + 1, value.y);
    store_scalar(to, first_plane + 2, value.z);
}

kernel void decode_gbuffer(global const uchar* restrict gbuffer, GBufferLayout layout, View view,
                           global const float* restrict srgb,  // [256]
                           // out [SURFACE_PLANES(_WITH_SPECULAR)][height][stride]; 0 for background
                           global float* restrict planes) {
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    GBuffer g = {gbuffer, layout, view, srgb};
    Pixels pixels = row_pixels(view, x, y);
    FV depth01 = load_depth01(g, pixels);
    SurfacePlanes to;
    to.planes = planes;
    to.plane_size = view.stride * view.height;
    to.first = pixels.first;
    to.drawn = lane_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    FV z = view_depth(view, pixels.x, pixels.y, lane_select(to.drawn, depth01, fv(1.0f)));
    Surface s = load_surface(g, pixels, z);
    store_scalar(to, SURFACE_DEPTH, z);
    store_vector(to, SURFACE_POSITION, s.position);
    store_vector(to, SURFACE_NORMAL, s.normal);
    store_vector(to, SURFACE_ALBEDO, s.albedo);
    store_scalar(to, SURFACE_ROUGHNESS, s.roughness);
    store_scalar(to, SURFACE_METALLIC, s.metallic);
    store_vector(to, SURFACE_EMISSIVE, s.emissive);
    store_scalar(to, SURFACE_OCCLUSION, s.occlusion);
#if HAS_SPECULAR
    store_vector(to, SURFACE_SPECULAR, s.specular);
    store_scalar(to, SURFACE_SPECULAR_F90, s.specular_f90);
#endif
}
