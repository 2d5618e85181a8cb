// SPDX-License-Identifier: Apache-2.0
// Alpha at a triangle's pixels: glTF's alphaModes MASK and BLEND. Sampled as resolve_surfaces does
// with one sample a pixel, whatever the anisotropy, and with the same bits on every device.
#ifndef KILOLUX_DEVICE_ALPHA_MASK_H
#define KILOLUX_DEVICE_ALPHA_MASK_H
#include "kernels/device/triangle.h"
#include "kernels/shared/surface_of.h"

typedef struct MaskedTriangle {
    MaterialRef material;
    TriangleEdges edges;
#if HAS_TEXCOORD0
    Texcoords texcoord0;
#endif
#if HAS_TEXCOORD1
    Texcoords texcoord1;
#endif
#if HAS_VERTEX_COLOR
    float alpha[3];
#endif
} MaskedTriangle;

// `number`: along the instances.
static inline MaskedTriangle fetch_masked_triangle(SurfaceScene scene, View view, uint number) {
    MaskedTriangle masked;
    Triangle t = fetch_triangle(scene, number + 1u);
    float3 v[3];
    for (uint i = 0; i < 3; ++i) {
        v[i] = view_vertex(t.instance, vertex_float3(t.vertex[i], 0u));
    }
    masked.material = scene.materials + t.mesh.material;
    masked.edges = triangle_edges(view, v[0], v[1], v[2]);
#if HAS_TEXCOORD0
    masked.texcoord0 = fetch_texcoords(t, t.mesh.texcoord0);
#endif
#if HAS_TEXCOORD1
    masked.texcoord1 = fetch_texcoords(t, t.mesh.texcoord1);
#endif
#if HAS_VERTEX_COLOR
    for (uint i = 0; i < 3; ++i) {
        masked.alpha[i] =
            t.mesh.color == SURFACE_ABSENT ? 1.0f : vertex_float(t.vertex[i], t.mesh.color + 3u);
    }
#endif
    return masked;
}

// What alpha reads of the fragments at pixels, whether the triangle covers them or not.
static inline Fragment alpha_fragment(View view, const MaskedTriangle* t, Pixels pixels) {
    Weights w = weights_of(view, pixels, t->edges);
    Fragment f;
#if HAS_TEXCOORD0
    f.texcoord0 = interpolate_texcoord(w, t->texcoord0);
#endif
#if HAS_TEXCOORD1
    f.texcoord1 = interpolate_texcoord(w, t->texcoord1);
#endif
#if HAS_VERTEX_COLOR
    f.color.w = interpolate(w, t->alpha[0], t->alpha[1], t->alpha[2]);
#endif
    return f;
}

// The share of the pixels that the material covers.
static inline FV material_coverage(SurfaceScene scene, View view, const MaskedTriangle* t,
                                   Pixels pixels) {
    Fragment f = alpha_fragment(view, t, pixels);
    return coverage_of(scene, t->material, &f);
}

// The pixels that an alpha mask keeps.
static inline MASK passes_mask(SurfaceScene scene, View view, const MaskedTriangle* t,
                               Pixels pixels) {
    Fragment f = alpha_fragment(view, t, pixels);
    return passes_cutoff(t->material, alpha_of(scene, t->material, &f));
}
#endif
