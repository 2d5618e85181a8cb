// SPDX-License-Identifier: Apache-2.0
// The G-buffer as shading sees it, in float planes: for AOVs, views and the float64 references.
// One work-item decodes VW neighbouring pixels of a row.
#include "kernels/device/gbuffer.h"
#include "kernels/shared/surface_planes.h"

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
    MASK drawn = full_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    FV z = view_depth(view, pixels.x, pixels.y, select_fv(drawn, depth01, fv(1.0f)));
    Surface s = load_surface(g, pixels, z);
#if HAS_SPECULAR
#define PLANES SURFACE_PLANES_WITH_SPECULAR
#define SPECULAR , s.specular.x, s.specular.y, s.specular.z, s.specular_f90
#else
#define PLANES SURFACE_PLANES
#define SPECULAR
#endif
    FV values[PLANES] = {z,
                         s.position.x,
                         s.position.y,
                         s.position.z,
                         s.normal.x,
                         s.normal.y,
                         s.normal.z,
                         s.albedo.x,
                         s.albedo.y,
                         s.albedo.z,
                         s.roughness,
                         s.metallic,
                         s.emissive.x,
                         s.emissive.y,
                         s.emissive.z,
                         s.occlusion SPECULAR};
    uint plane = view.stride * view.height;
    for (uint i = 0; i < PLANES; ++i) {
        store_lanes(select_fv(drawn, values[i], fv(0.0f)), planes + i * plane + pixels.first);
    }
}
