// SPDX-License-Identifier: Apache-2.0
// What alpha cuts out of a triangle, at its pixels: glTF's alphaMode MASK. Sampled as
// resolve_surfaces does with one sample a pixel, whatever the anisotropy, and with the same bits on
// every device.
#ifndef KILOLUX_DEVICE_ALPHA_MASK_H
#define KILOLUX_DEVICE_ALPHA_MASK_H
#include "kernels/device/footprint.h"

typedef struct MaskedTriangle {
    Triangle triangle;
    float3 v[3];  // view space [m]
} MaskedTriangle;

// `number`: along the instances.
static inline MaskedTriangle fetch_masked_triangle(SurfaceScene scene, uint number) {
    MaskedTriangle out;
    out.triangle = fetch_triangle(scene, number + 1u);
    for (uint i = 0; i < 3; ++i) {
        out.v[i] = view_vertex(out.triangle.instance, vload3(0, out.triangle.vertex[i]));
    }
    return out;
}

// The pixels that alpha leaves; said of all, covered or not.
static inline MASK passes_mask(SurfaceScene scene, View view, const MaskedTriangle* t,
                               Pixels pixels) {
    global const SurfaceMaterial* material = scene.materials + t->triangle.mesh.material;
    MASK front;
    Weights w = weights_of(view, pixels, t->v, &front);
    FV alpha = fv(material->row.base_color.w);
#if HAS_TEXCOORD0 || HAS_TEXCOORD1
    uint texture = material->textures[USE_BASE_COLOR];
    if (texture != SURFACE_ABSENT) {
        Fragment f;
#if HAS_TEXCOORD0
        f.texcoord0 = interpolate_texcoord(w, t->triangle, t->triangle.mesh.texcoord0);
#endif
#if HAS_TEXCOORD1
        f.texcoord1 = interpolate_texcoord(w, t->triangle, t->triangle.mesh.texcoord1);
#endif
        TextureBuffers buffers = {scene.textures, scene.texels};
        global const TextureRow* row = scene.textures + texture;
        Lookup at = lookup_isotropic(row, footprint_of(material, &f, USE_BASE_COLOR));
        alpha *= fetch_alpha(buffers, row, &at);
    }
#endif
#if HAS_VERTEX_COLOR
    uint color = t->triangle.mesh.color;
    if (color != SURFACE_ABSENT) {
        alpha *= interpolate(w, t->triangle.vertex[0][color + 3], t->triangle.vertex[1][color + 3],
                             t->triangle.vertex[2][color + 3]);
    }
#endif
    return lane_mask(!(alpha < fv(material->row.emissive_cutoff.w)));
}
#endif
