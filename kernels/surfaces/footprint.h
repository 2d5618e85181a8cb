// SPDX-License-Identifier: Apache-2.0
// Where a material's texture is read at fragments: texture coordinates, transformed.
//
// TEXTURE_USES has the bit 1 << USE_* of every texture that some material of the scene has and the
// G-buffer keeps.
#ifndef KILOLUX_DEVICE_FOOTPRINT_H
#define KILOLUX_DEVICE_FOOTPRINT_H
#include "kernels/device/texture.h"
#include "kernels/device/triangle.h"

#define HAS_USE(use) ((TEXTURE_USES & (1 << (use))) != 0)

#if HAS_TEXCOORD0 || HAS_TEXCOORD1
static inline Footprint footprint_of(global const SurfaceMaterial* material, const Fragment* f,
                                     uint use) {
#if HAS_TEXCOORD0 && HAS_TEXCOORD1
    Footprint t = f->texcoord0;
    if ((material->flags & (1u << use)) != 0u) t = f->texcoord1;
#elif HAS_TEXCOORD1
    Footprint t = f->texcoord1;
#else
    Footprint t = f->texcoord0;
#endif
#if HAS_UV_TRANSFORM
    float4 x = material->row.uv_x[use];
    float4 y = material->row.uv_y[use];
    Footprint at;
    at.u = fma(fv(x.x), t.u, fma(fv(x.y), t.v, fv(x.z)));
    at.v = fma(fv(y.x), t.u, fma(fv(y.y), t.v, fv(y.z)));
    at.u_dx = fma(fv(x.x), t.u_dx, t.v_dx * x.y);
    at.v_dx = fma(fv(y.x), t.u_dx, t.v_dx * y.y);
    at.u_dy = fma(fv(x.x), t.u_dy, t.v_dy * x.y);
    at.v_dy = fma(fv(y.x), t.u_dy, t.v_dy * y.y);
    return at;
#else
    return t;
#endif
}
#endif
#endif
