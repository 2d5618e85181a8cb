// SPDX-License-Identifier: Apache-2.0
// Alpha masks of triangles that cast shadows. A ray has no footprint: the base colour's alpha is
// read at its finest level.
#ifndef KILOLUX_DEVICE_MASKED_CASTER_H
#define KILOLUX_DEVICE_MASKED_CASTER_H
#include "kernels/device/texture.h"
#include "kernels/shared/shadow.h"

#ifndef HAS_MASKED_CASTERS
#define HAS_MASKED_CASTERS 0
#endif

typedef struct MaskedScene {
    global const MaskedCaster* casters;
    global const SurfaceMaterial* materials;
    TextureBuffers textures;
} MaskedScene;

// Weights of corners 1 and 2 of a caster.
typedef struct CasterWeights {
    FV b1, b2;
} CasterWeights;

// u0..u2: in proportion to the weights; rounding may make them slightly negative.
static inline CasterWeights caster_weights(FV u0, FV u1, FV u2) {
    u0 = max(u0, fv(0.0f));
    u1 = max(u1, fv(0.0f));
    u2 = max(u2, fv(0.0f));
    FV inv = fv(1.0f) / max(u0 + u1 + u2, fv(1e-36f));
    return (CasterWeights){u1 * inv, u2 * inv};
}

static inline FV weighted(const float* corners, CasterWeights w) {
    return fma(w.b2, fv(corners[2] - corners[0]),
               fma(w.b1, fv(corners[1] - corners[0]), fv(corners[0])));
}

#if HAS_MASKED_CASTERS
// Where alpha keeps caster `number`.
static inline MASK is_opaque_at(MaskedScene scene, uint number, CasterWeights w) {
    MaskedCaster caster = scene.casters[number];
    global const SurfaceMaterial* material = scene.materials + caster.material;
    FV alpha = weighted(caster.alpha, w) * material->row.base_color.w;
    uint texture = material->textures[USE_BASE_COLOR];
    if (texture != SURFACE_ABSENT) {
        FV s = weighted(caster.u, w);
        FV t = weighted(caster.v, w);
#if HAS_UV_TRANSFORM
        float4 x = material->row.uv_x[USE_BASE_COLOR];
        float4 y = material->row.uv_y[USE_BASE_COLOR];
        FV u = fma(fv(x.x), s, fma(fv(x.y), t, fv(x.z)));
        t = fma(fv(y.x), s, fma(fv(y.y), t, fv(y.z)));
        s = u;
#endif
        Map map = make_map(scene.textures, texture, USE_BASE_COLOR);
        const Lookup at = make_lookup(map, s, t, fv(-1.0f));
        alpha *= fetch_alpha(map, REF(at));
    }
    return lane_mask(!(alpha < fv(material->row.emissive_cutoff.w)));
}
#endif
#endif
