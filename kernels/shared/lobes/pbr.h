// SPDX-License-Identifier: Apache-2.0
// The light of glTF's model, SHADING_PBR: diffuse and specular light of the surface, below its
// sheen and its clear coat.
#ifndef KILOLUX_SHARED_LOBES_PBR_H
#define KILOLUX_SHARED_LOBES_PBR_H
#include "kernels/shared/lobes/ggx.h"
#include "kernels/shared/lobes/light_sum.h"
#include "kernels/shared/lobes/passed_light.h"
#include "kernels/shared/lobes/sheen.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/types.h"

#if SHADING == SHADING_PBR
#if defined(__cplusplus)
namespace kilolux {
#endif

// The light that meets a surface.
SHARED_PLAIN_STRUCT(IncidentLight) {
    FV3 v;          // towards the light
    FV inv_length;  // of v
    FV n_dot_l;     // at least 0
    FV weight;      // intensity's weight * falloff
    FV lit;         // that times n.l
};

// `lobe` times its reflectance, plus what the layers above reflect.
SHARED_FN FV specular_weight(FV lobe, FV reflectance, FV above) {
#if HAS_COAT || HAS_SHEEN_LOBE
    return fma(lobe, reflectance, above);
#else
    return lobe * reflectance;
#endif
}

// Adds `lobe` times its reflectance at Schlick's rise f, and the weights `above` of what coat and
// sheen do. g: 1 - f.
SHARED_FN LightSum add_specular(LightSum sum, ShadingPoint p, FV lobe, FV f, FV g, FV3 above,
                                float4 color) {
#if HAS_SPECULAR
    f = f * p.f90;
#endif
#if F0_VARIES
    FV3 reflectance = fv3(fma(g, p.f0.x, f), fma(g, p.f0.y, f), fma(g, p.f0.z, f));
#else
    FV grey = fma(g, fv(DIELECTRIC_F0), f);
    FV3 reflectance = fv3(grey, grey, grey);
#endif
    FV weight = specular_weight(lobe, reflectance.x, above.x);
#if F0_VARIES || HAS_SHEEN_LOBE
    FV weight_y = specular_weight(lobe, reflectance.y, above.y);
    FV weight_z = specular_weight(lobe, reflectance.z, above.z);
    sum.specular =
        fv3(fma(weight, fv(color.x), sum.specular.x), fma(weight_y, fv(color.y), sum.specular.y),
            fma(weight_z, fv(color.z), sum.specular.z));
#else
    sum.specular = add_scaled(sum.specular, weight, color);
#endif
    return sum;
}

// Adds the light that the surface below coat and sheen reflects, and what they do, by its weights
// `above`.
SHARED_FN LightSum add_pbr(LightSum sum, ShadingPoint p, HalfVector half_way, IncidentLight from,
                           FV3 above, float4 color) {
    FV lit = from.lit;
#if HAS_ANISOTROPY
    FV lobe = stretched_light(p.lobe, half_way, from.n_dot_l, lit);
#else
    FV lobe = ggx_light(p.lobe, half_way, from.n_dot_l, lit);
#endif
    FV f = schlick_rise(fma(-dot3(p.to_eye, half_way.h), lane_rsqrt(half_way.hh), fv(1.0f)));
    FV kept = diffuse_share(p, f), g = kept;
#if HAS_SPECULAR
    g = fv(1.0f) - f;
#endif
    sum.diffuse = add_scaled(sum.diffuse, lit * kept, color);
    return add_specular(sum, p, lobe, f, g, above, color);
}

#if HAS_COAT
// The weight of light that the coat reflects: exactly 0 without a coat.
SHARED_FN FV coat_light(ShadingPoint p, HalfVector half_way, IncidentLight from) {
#if HAS_COAT_NORMAL
    from.n_dot_l = max(dot3(p.coat_normal, from.v), fv(0.0f)) * from.inv_length;
    from.lit = from.weight * from.n_dot_l;
    half_way = about_normal(half_way, p.coat_normal);
#endif
    return ggx_light(p.coat, half_way, from.n_dot_l, from.lit * p.coat_share);
}
#endif

#if HAS_SHEEN_LOBE
// The weights of light that the coat and, below it, the sheen reflect: exactly 0 without a colour.
SHARED_FN FV3 weights_with_sheen(FV coat, ShadingPoint p, HalfVector half_way, IncidentLight from) {
    FV n_dot_h = dot3(p.normal, half_way.h);
    FV lobe = sheen_light(p.sheen, half_way.sin2, n_dot_h * n_dot_h, half_way.hh, from.n_dot_l);
    FV sheen = from.weight * lobe;
    return fv3(fma(sheen, p.sheen_color.x, coat), fma(sheen, p.sheen_color.y, coat),
               fma(sheen, p.sheen_color.z, coat));
}
#endif

SHARED_FN LightSum add_lobes(LightSum sum, ShadingPoint p, IncidentLight from, float4 color) {
    HalfVector half_way = half_vector(p.normal, p.to_eye, from.v, from.inv_length);
    FV coat = fv(0.0f);
    // Where no lane has the lobe, it would add nothing: lobes cost what surfaces have of them.
#if HAS_COAT
    if (lane_any(p.coat_share > fv(0.0f))) {
        coat = coat_light(p, half_way, from);
        from.lit = from.lit * p.below_coat;
    }
#endif
    FV3 above = fv3(coat, coat, coat);
#if HAS_SHEEN_LOBE
    if (lane_any(p.sheen_most > fv(0.0f))) {
        above = weights_with_sheen(coat, p, half_way, from);
        from.lit = from.lit * below_sheen(p, from.n_dot_l);
    }
#endif
    return add_pbr(sum, p, half_way, from, above, color);
}

#if HAS_COAT
// The largest cosine of an angle to `other` of what has `cosine` >= 0 to `normal` at most.
SHARED_FN FV turned_cosine(FV cosine, FV3 normal, FV3 other) {
    FV3 across = cross3(normal, other);
    FV sine = lane_sqrt(max(fma(-cosine, cosine, fv(1.0f)), fv(0.0f)));
    FV between = dot3(normal, other);
    // More than the rounding of normals and their lengths.
    FV turned = fma(cosine, between, fma(sine, lane_sqrt(dot3(across, across)), fv(1e-5f)));
    return lane_select(cosine < between, min(turned, fv(1.0f)), fv(1.0f));
}
#endif

// Adds the largest sums that the light can cause.
SHARED_FN LightSum add_pbr_bounds(LightSum sum, Surface s, ShadingPoint p, LightBound most) {
#if HAS_COAT
    FV coat_peak = ggx_bound(p.coat, turned_cosine(most.cosine, p.normal, p.coat_normal));
    // Without a coat its lobe counts for nothing, also where the light overflows.
    MASK has_coat = p.coat_share > fv(0.0f);
    FV3 coat = scale3(most.all, p.coat_share * coat_peak);
    sum.specular = add3(sum.specular, fv3(lane_select(has_coat, coat.x, fv(0.0f)),
                                          lane_select(has_coat, coat.y, fv(0.0f)),
                                          lane_select(has_coat, coat.z, fv(0.0f))));
    most.diffuse = scale3(most.diffuse, p.below_coat);
#endif
    sum.diffuse = add3(sum.diffuse, most.diffuse);
    FV one = fv(1.0f);
    FV peak = ggx_bound(p.lobe, most.cosine);
#if HAS_COAT
    peak = peak * p.below_coat;
#endif
    FV3 f0 = mixed_f0(s, dielectric_f0(s));
    FV3 f = fv3(min(f0.x + most.fresnel, one), min(f0.y + most.fresnel, one),
                min(f0.z + most.fresnel, one));
    sum.specular = fv3(fma(f.x, peak * most.all.x, sum.specular.x),
                       fma(f.y, peak * most.all.y, sum.specular.y),
                       fma(f.z, peak * most.all.z, sum.specular.z));
#if HAS_SHEEN_LOBE
    FV sheen = sheen_bound(p.sheen, p.lobe.n_dot_v);
    MASK has_sheen = p.sheen_most > fv(0.0f);
    sum.specular = fv3(
        sum.specular.x + lane_select(has_sheen, p.sheen_color.x * (sheen * most.all.x), fv(0.0f)),
        sum.specular.y + lane_select(has_sheen, p.sheen_color.y * (sheen * most.all.y), fv(0.0f)),
        sum.specular.z + lane_select(has_sheen, p.sheen_color.z * (sheen * most.all.z), fv(0.0f)));
#endif
    return sum;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
#endif
