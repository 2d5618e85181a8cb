// SPDX-License-Identifier: Apache-2.0
// What alpha cuts out of a triangle, at its pixels: glTF's alphaMode MASK. Sampled as
// resolve_surfaces does with one sample a pixel, whatever the anisotropy, and with the same bits on
// every device.
#ifndef KILOLUX_DEVICE_ALPHA_MASK_H
#define KILOLUX_DEVICE_ALPHA_MASK_H
#include "kernels/surfaces/footprint.h"

typedef struct MaskedTriangle {
    global const SurfaceMaterial* material;
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
    MaskedTriangle out;
    Triangle t = fetch_triangle(scene, number + 1u);
    float3 v[3];
    for (uint i = 0; i < 3; ++i) v[i] = view_vertex(t.instance, vload3(0, t.vertex[i]));
    out.material = scene.materials + t.mesh.material;
    out.edges = triangle_edges(view, v);
#if HAS_TEXCOORD0
    out.texcoord0 = fetch_texcoords(t, t.mesh.texcoord0);
#endif
#if HAS_TEXCOORD1
    out.texcoord1 = fetch_texcoords(t, t.mesh.texcoord1);
#endif
#if HAS_VERTEX_COLOR
    for (uint i = 0; i < 3; ++i) {
        out.alpha[i] = t.mesh.color == SURFACE_ABSENT ? 1.0f : t.vertex[i][t.mesh.color + 3];
    }
#endif
    return out;
}

// The pixels that alpha leaves; said of all, covered or not.
static inline MASK passes_mask(SurfaceScene scene, View view, const MaskedTriangle* t,
                               Pixels pixels) {
    MASK front;
    Weights w = weights_of(view, pixels, t->edges, &front);
    FV alpha = fv(t->material->row.base_color.w);
#if HAS_TEXCOORD0 || HAS_TEXCOORD1
    uint texture = t->material->textures[USE_BASE_COLOR];
    if (texture != SURFACE_ABSENT) {
        Fragment f;
#if HAS_TEXCOORD0
        f.texcoord0 = interpolate_texcoord(w, t->texcoord0);
#endif
#if HAS_TEXCOORD1
        f.texcoord1 = interpolate_texcoord(w, t->texcoord1);
#endif
        TextureBuffers buffers = {scene.textures, scene.texels};
        global const TextureRow* row = scene.textures + texture;
        Lookup at = lookup_isotropic(row, footprint_of(t->material, &f, USE_BASE_COLOR));
        alpha *= fetch_alpha(buffers, row, &at);
    }
#endif
#if HAS_VERTEX_COLOR
    alpha *= interpolate(w, t->alpha[0], t->alpha[1], t->alpha[2]);
#endif
    return lane_mask(!(alpha < fv(t->material->row.emissive_cutoff.w)));
}
#endif
