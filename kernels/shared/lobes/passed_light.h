// SPDX-License-Identifier: Apache-2.0
// How much light coat, sheen, metal and specular reflection leave to diffuse reflection and to what
// goes through the surface.
#ifndef KILOLUX_SHARED_LOBES_PASSED_LIGHT_H
#define KILOLUX_SHARED_LOBES_PASSED_LIGHT_H
#include "kernels/shared/lobes/ggx.h"
#include "kernels/shared/lobes/sheen.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// The share of light that the coat leaves to what is below it.
SHARED_FN FV share_below_coat(ShadingPoint p) {
#if HAS_COAT
    return p.below_coat;
#else
    return fv(1.0f);
#endif
}

#if HAS_SHEEN_LOBE
// The share of light at a cosine that the sheen leaves to the surface below it: sheenAlbedoScaling.
SHARED_FN FV below_sheen(ShadingPoint p, FV cosine) {
    FV taken = max(p.sheen.albedo, sheen_albedo(p.sheen, cosine));
    return fma(-p.sheen_most, taken, fv(1.0f));
}
#endif

// What a surface reflects of even light from all directions, `light` of each colour: `below` is
// that without its sheen.
SHARED_FN FV3 with_even_sheen(Surface s, ShadingPoint p, FV3 below, FV3 light) {
#if HAS_SHEEN_LOBE
    FV left = fma(-p.sheen_most, p.sheen.albedo, fv(1.0f));
    FV3 sheen = scale3(light, p.sheen.albedo);
    return fv3(below.x * left + s.sheen.x * sheen.x, below.y * left + s.sheen.y * sheen.y,
               below.z * left + s.sheen.z * sheen.z);
#else
    return below;
#endif
}

// The share of the base colour's light that goes through the surface and is not scattered.
SHARED_FN FV transmitting_share(Surface s) {
#if HAS_TRANSMISSION && SHADING != SHADING_LAMBERT && HAS_METALLIC
    return s.transmission * (fv(1.0f) - s.metallic);
#elif HAS_TRANSMISSION
    return s.transmission;
#else
    return fv(0.0f);
#endif
}

// The albedo of ambient light, which metal scatters, too.
SHARED_FN FV3 even_albedo(Surface s) { return scale3(s.albedo, fv(1.0f) - transmitting_share(s)); }

#if SHADING == SHADING_PBR
// The share of diffuse light that specular reflection leaves at Schlick's rise, relative to head
// on.
SHARED_FN FV diffuse_share(ShadingPoint p, FV rise) {
#if HAS_SPECULAR
    return fma(-rise, p.diffuse_loss, fv(1.0f));
#else
    return fv(1.0f) - rise;
#endif
}
#endif

// `scale` times the albedo of the diffuse lobe, head on, below coat and sheen.
SHARED_FN FV3 diffuse_albedo(Surface s, FV scale) {
#if HAS_TRANSMISSION
    scale = scale * (fv(1.0f) - s.transmission);
#endif
    FV3 albedo = s.albedo;
#if SHADING != SHADING_LAMBERT && HAS_METALLIC
    albedo = scale3(albedo, fv(1.0f) - s.metallic);
#endif
    albedo = scale3(albedo, scale);
#if SHADING == SHADING_PBR
    FV3 f0 = diffuse_f0(s);
    albedo = fv3(albedo.x * (fv(1.0f) - f0.x), albedo.y * (fv(1.0f) - f0.y),
                 albedo.z * (fv(1.0f) - f0.z));
#endif
    return albedo;
}

#if HAS_TRANSMISSION
// The share of the light behind the surface that it lets through: straight on, whatever the
// roughness; glTF's dielectric with the half vector along the normal.
SHARED_FN FV3 transmitted_share(Surface s, ShadingPoint p) {
    FV through = transmitting_share(s);
    FV3 share = fv3(s.albedo.x * s.tint.x, s.albedo.y * s.tint.y, s.albedo.z * s.tint.z);
#if SHADING == SHADING_PBR
    FV kept = diffuse_share(p, schlick_rise(fv(1.0f) - p.lobe.n_dot_v));
    through = through * (kept * (fv(1.0f) - largest_channel(dielectric_f0(s))));
#if HAS_SHEEN_LOBE
    through = through * below_sheen(p, p.lobe.n_dot_v);
#endif
    through = through * share_below_coat(p);
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

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
