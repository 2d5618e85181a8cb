// SPDX-License-Identifier: Apache-2.0
// What a surface that blends or transmits lets through of the light behind it, for OpenCL C and
// GLSL.
#ifndef KILOLUX_SHARED_SHARE_BEHIND_H
#define KILOLUX_SHARED_SHARE_BEHIND_H
#include "kernels/shared/evaluate.h"

#if HAS_TRANSMISSION
// The share of the light behind the surface that it lets through: straight on, whatever the
// roughness; glTF's dielectric with the half vector along the normal.
SHARED_FN FV3 transmitted_share(Surface s, ShadingPoint p) {
    FV through = transmitting_share(s);
    FV3 share = fv3(s.albedo.x * s.tint.x, s.albedo.y * s.tint.y, s.albedo.z * s.tint.z);
#if SHADING == SHADING_PBR
    FV schlick = max(fv(1.0f) - p.lobe.n_dot_v, fv(0.0f));
    FV schlick2 = schlick * schlick;
    FV f = schlick2 * schlick2 * schlick;
    FV kept = fv(1.0f) - f;
#if HAS_SPECULAR
    kept = fma(f, p.diffuse_rises, kept);
#endif
    FV3 f0 = dielectric_f0(s);
    kept = kept * (fv(1.0f) - max(max(f0.x, f0.y), f0.z));
    through = through * kept;
#if HAS_SHEEN_LOBE
    through = through * below_sheen(p, p.lobe.n_dot_v);
#endif
#if HAS_COAT
    through = through * (fv(1.0f) - p.coat_share);
#endif
#endif
    return scale3(share, through);
}
#endif

// The share of the light behind a surface that reaches the eye, where `alpha` is covered.
SHARED_FN FV3 share_behind(Surface s, ShadingPoint p, FV alpha) {
    FV bare = fv(1.0f) - alpha;
#if HAS_TRANSMISSION
    FV3 share = transmitted_share(s, p);
    return fv3(fma(alpha, share.x, bare), fma(alpha, share.y, bare), fma(alpha, share.z, bare));
#else
    return fv3(bare, bare, bare);
#endif
}
#endif
