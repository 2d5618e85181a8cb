// SPDX-License-Identifier: Apache-2.0
// The light that one light adds to one shading point, for the OpenCL kernels (VW pixels at once)
// and for GLSL (one fragment). No other code evaluates a light on a surface.
//
//   pixel = emissive + ambient * occlusion * albedo + sum over lights of
//           brdf * intensity * falloff * n.l
//   falloff(d) = window(d / range) / max(d, LIGHT_D_MIN)^2,  window(x) = clamp(1 - x^4, 0, 1)
//   (KHR_lights_punctual, "Range Property")
//
// The window is exactly 0 where d >= range, so a light that is listed but out of range adds exactly
// nothing. Switches: those of surface.h, FAST_RSQRT and NATIVE_MATH of types.h, EARLY_OUT, and
// HAS_RANDOM_RANGES, where lights may have random ranges (light_transform.h): then RANDOM_RANGES is
// pi times the radiance that such a light causes on a white surface at the least of them;
// HAS_LIGHT_PROFILES, where lights may have photometric webs: then evaluate() takes them and the
// light's index. The macro EVALUATE takes them in any case, and drops them where there are none.
#ifndef KILOLUX_SHARED_EVALUATE_H
#define KILOLUX_SHARED_EVALUATE_H
#include "kernels/shared/light.h"
#include "kernels/shared/light_sum.h"
#include "kernels/shared/power.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/types.h"

#ifndef HAS_RANDOM_RANGES
#define HAS_RANDOM_RANGES 0
#endif
#ifndef HAS_LIGHT_PROFILES
#define HAS_LIGHT_PROFILES 0
#endif
#if HAS_LIGHT_PROFILES
#include "kernels/shared/light_profile.h"
#define EVALUATE(sum, p, light, profiles, index) evaluate(sum, p, light, profiles, index)
#else
#define EVALUATE(sum, p, light, profiles, index) evaluate(sum, p, light)
#endif

// Returns early for a light whose window is 0 in all lanes, before its costly part. It pays for all
// models but lambert, where the branch costs more than it saves, unless lights have profiles.
#ifndef EARLY_OUT
#define EARLY_OUT (SHADING != SHADING_LAMBERT || HAS_LIGHT_PROFILES)
#endif

#define INV_PI 0.318309886f

#if defined(__cplusplus)
namespace kilolux {
#endif

#if SHADING == SHADING_BLINN_PHONG
// Light of `lit` = intensity's weight * falloff * n.l from the direction `v`, `distance` long.
SHARED_FN LightSum add_blinn_phong(LightSum sum, ShadingPoint p, FV3 v, FV distance, FV lit,
                                   float4 color) {
    // The half vector, `distance` times as long, so that v need not be normalised yet.
    FV3 h = fv3(fma(p.to_eye.x, distance, v.x), fma(p.to_eye.y, distance, v.y),
                fma(p.to_eye.z, distance, v.z));
    FV hh = max(dot3(h, h), fv(1e-30f));  // light from straight behind the view has none
    FV n_dot_h = dot3(p.normal, h);
    // |n x h|^2 keeps the shape of narrow lobes, which n.h rounds away at large exponents.
    FV3 nxh = cross3(p.normal, h);
    FV lobe = pow_of_cos2(n_dot_h * n_dot_h, dot3(nxh, nxh), hh, p.exponent);
    lobe = lane_select(n_dot_h > fv(0.0f), lobe, fv(0.0f));
    sum.diffuse = add_scaled(sum.diffuse, lit, color);
    sum.specular = add_scaled(sum.specular, lit * lobe, color);
    return sum;
}

#elif SHADING == SHADING_PBR
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

// Adds the light of the surface below coat and sheen, and `above`, the weights of what they
// reflect.
SHARED_FN LightSum add_pbr(LightSum sum, ShadingPoint p, HalfVector half_way, IncidentLight from,
                           FV3 above, float4 color) {
    FV lit = from.lit;
#if HAS_ANISOTROPY
    FV lobe = stretched_light(p.lobe, half_way, from.n_dot_l, lit);
#else
    FV lobe = ggx_light(p.lobe, half_way, from.n_dot_l, lit);
#endif
    FV schlick = max(fma(-dot3(p.to_eye, half_way.h), lane_rsqrt(half_way.hh), fv(1.0f)), fv(0.0f));
    FV schlick2 = schlick * schlick;
    FV f = schlick2 * schlick2 * schlick;
    FV g = fv(1.0f) - f;
#if HAS_SPECULAR
    sum.diffuse = add_scaled(sum.diffuse, lit * fma(f, p.diffuse_rises, g), color);
    f = f * p.f90;
#else
    sum.diffuse = add_scaled(sum.diffuse, lit * g, color);
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
// The share of light at a cosine that the sheen leaves to the surface below it: sheenAlbedoScaling.
SHARED_FN FV below_sheen(ShadingPoint p, FV cosine) {
    FV taken = max(p.sheen.albedo, sheen_albedo(p.sheen, cosine));
    return fma(-p.sheen_most, taken, fv(1.0f));
}

// The weights of light that the coat and, below it, the sheen reflect: exactly 0 without a colour.
SHARED_FN FV3 add_sheen(FV coat, ShadingPoint p, HalfVector half_way, IncidentLight from) {
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
        above = add_sheen(coat, p, half_way, from);
        from.lit = from.lit * below_sheen(p, from.n_dot_l);
    }
#endif
    return add_pbr(sum, p, half_way, from, above, color);
}
#endif

// The share of a spot light's intensity in the direction -`v` / distance.
SHARED_FN FV cone_of(FV3 v, FV inv_distance, ShadeLight light) {
    FV along =
        fma(v.x, fv(light.axis_cos.x), fma(v.y, fv(light.axis_cos.y), v.z * fv(light.axis_cos.z)));
    FV cos_axis = -along * inv_distance;
    FV cone =
        min(max((cos_axis - fv(light.axis_cos.w)) * fv(light.color_scale.w), fv(0.0f)), fv(1.0f));
    return cone * cone;
}

#if HAS_RANDOM_RANGES
// One over the probability that a light's random range covers a distance.
SHARED_FN FV random_range_weight(ShadeLight light, FV d2) {
    float4 color = light.color_scale;
    return max(d2 * fv(RANDOM_RANGES / max(max(color.x, color.y), color.z)), fv(1.0f));
}
#endif

// The factor of the window on a light's inverse square.
SHARED_FN FV window_of(ShadeLight light, FV d2) {
    FV x = d2 * fv(light.position_inv_range2.w);
#if HAS_RANDOM_RANGES
    if (has_random_range(light)) {
        return lane_select(x > fv(-1.0f), random_range_weight(light, d2), fv(0.0f));
    }
#endif
    return max(fma(-x, x, fv(1.0f)), fv(0.0f));
}

// Adds a point or spot light.
#if HAS_LIGHT_PROFILES
SHARED_FN LightSum evaluate(LightSum sum, ShadingPoint p, ShadeLight light, LightProfiles profiles,
                            uint index) {
#else
SHARED_FN LightSum evaluate(LightSum sum, ShadingPoint p, ShadeLight light) {
#endif
    FV3 v = fv3(fv(light.position_inv_range2.x) - p.position.x,
                fv(light.position_inv_range2.y) - p.position.y,
                fv(light.position_inv_range2.z) - p.position.z);
    FV d2 = dot3(v, v);
    FV window = window_of(light, d2);
#if EARLY_OUT
    if (!lane_any(window > fv(0.0f))) return sum;
#endif
#if HAS_LIGHT_PROFILES
    window = window * profile_share(profiles, index, v);
#endif
    FV e2 = max(d2, fv(LIGHT_D_MIN * LIGHT_D_MIN));
    FV n_dot_v = max(dot3(p.normal, v), fv(0.0f));  // n.l times the distance
#if SHADING == SHADING_PBR || FAST_RSQRT
    FV inv_d = lane_rsqrt(e2);
#if HAS_SPOT_LIGHTS
    window = window * cone_of(v, inv_d, light);
#endif
    FV n_dot_l = n_dot_v * inv_d;
    FV weight = window * (inv_d * inv_d);
    FV lit = weight * n_dot_l;
#else
    // One root and one division, and as few products as possible.
    FV distance = lane_sqrt(e2);
#if HAS_SPOT_LIGHTS
    window = window * cone_of(v, fv(1.0f) / distance, light);
#endif
    FV lit = lane_divide(window * n_dot_v, e2 * distance);
#endif
#if SHADING == SHADING_PBR
    IncidentLight from;
    from.v = v;
    from.inv_length = inv_d;
    from.n_dot_l = n_dot_l;
    from.weight = weight;
    from.lit = lit;
    return add_lobes(sum, p, from, light.color_scale);
#elif SHADING == SHADING_BLINN_PHONG
#if FAST_RSQRT
    FV distance = e2 * inv_d;
#endif
    return add_blinn_phong(sum, p, v, distance, lit, light.color_scale);
#else
sum.diffuse = add_scaled(sum.diffuse, lit, light.color_scale);
return sum;
#endif
}

SHARED_FN LightSum evaluate_directional(LightSum sum, ShadingPoint p, DirectionalLight light) {
    FV3 to_light = fv3(fv(light.to_light.x), fv(light.to_light.y), fv(light.to_light.z));
    FV n_dot_l = max(dot3(p.normal, to_light), fv(0.0f));
#if SHADING == SHADING_PBR
    IncidentLight from;
    from.v = to_light;
    from.inv_length = from.weight = fv(1.0f);
    from.n_dot_l = from.lit = n_dot_l;
    return add_lobes(sum, p, from, light.color);
#elif SHADING == SHADING_BLINN_PHONG
    return add_blinn_phong(sum, p, to_light, fv(1.0f), n_dot_l, light.color);
#else
    sum.diffuse = add_scaled(sum.diffuse, n_dot_l, light.color);
    return sum;
#endif
}

#if HAS_SHEEN_LOBE
// Radiance of sheen that reflects `light`, beside that of the surface below it.
SHARED_FN FV3 with_sheen_light(Surface s, ShadingPoint p, FV3 below, FV3 light) {
    // Without a colour its lobe counts for nothing, also where it overflows.
    MASK has_sheen = p.sheen_most > fv(0.0f);
    return fv3(below.x + lane_select(has_sheen, s.sheen.x * light.x, fv(0.0f)),
               below.y + lane_select(has_sheen, s.sheen.y * light.y, fv(0.0f)),
               below.z + lane_select(has_sheen, s.sheen.z * light.z, fv(0.0f)));
}
#endif

// Radiance that the surface reflects, from the sums over its lights.
SHARED_FN FV3 reflected_radiance(Surface s, ShadingPoint p, LightSum sum) {
    FV3 albedo = s.albedo;
    FV k = fv(INV_PI);
#if HAS_TRANSMISSION
    k = k * (fv(1.0f) - s.transmission);
#endif
    FV3 out_radiance;
#if SHADING == SHADING_LAMBERT
    out_radiance = fv3(albedo.x * k * sum.diffuse.x, albedo.y * k * sum.diffuse.y,
                       albedo.z * k * sum.diffuse.z);
#else
    FV3 base = albedo;
#if HAS_METALLIC
    base = scale3(albedo, fv(1.0f) - s.metallic);
#endif
#endif
#if SHADING == SHADING_BLINN_PHONG
    FV3 f0 = mixed_f0(s, dielectric_f0(s));
    FV alpha = clamped_alpha(s.roughness);
    // (n + 2) / (8 pi) with n = 2 / alpha2 - 2: Walter et al. 2007's match of exponent and
    // roughness.
    FV lobe = fv(0.25f * INV_PI) / (alpha * alpha);
    out_radiance = fv3(fma(base.x * k, sum.diffuse.x, f0.x * lobe * sum.specular.x),
                       fma(base.y * k, sum.diffuse.y, f0.y * lobe * sum.specular.y),
                       fma(base.z * k, sum.diffuse.z, f0.z * lobe * sum.specular.z));
#endif
#if SHADING == SHADING_PBR
    FV lobe = fv(0.5f * INV_PI);
    FV3 f0 = diffuse_f0(s);
    out_radiance = fv3(fma(base.x * k * (fv(1.0f) - f0.x), sum.diffuse.x, lobe * sum.specular.x),
                       fma(base.y * k * (fv(1.0f) - f0.y), sum.diffuse.y, lobe * sum.specular.y),
                       fma(base.z * k * (fv(1.0f) - f0.z), sum.diffuse.z, lobe * sum.specular.z));
#endif
#if HAS_UNLIT
    MASK lit = is_lit(s);
    out_radiance =
        fv3(lane_select(lit, out_radiance.x, fv(0.0f)), lane_select(lit, out_radiance.y, fv(0.0f)),
            lane_select(lit, out_radiance.z, fv(0.0f)));
#endif
    return out_radiance;
}

// Upper bounds of the factors of the light that a surface receives.
SHARED_PLAIN_STRUCT(LightBound) {
    FV cosine;       // n.h
    FV fresnel;      // Schlick's (1 - v.h)^5
    FV3 diffuse;     // the diffuse sum
    FV3 all;         // the sum of intensity / distance^2
    FV3 irradiance;  // that sum times n.l, or `all` where n.l is unknown
};

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
SHARED_FN LightSum add_bounds(LightSum sum, Surface s, ShadingPoint p, LightBound most) {
#if HAS_COAT
    FV coat_peak = ggx_bound(p.coat, turned_cosine(most.cosine, p.normal, p.coat_normal));
    sum.specular = add3(sum.specular, scale3(most.all, p.coat_share * coat_peak));
    most.diffuse = scale3(most.diffuse, p.below_coat);
#endif
    sum.diffuse = add3(sum.diffuse, most.diffuse);
#if SHADING == SHADING_PBR
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
    sum.specular = fv3(fma(p.sheen_color.x, sheen * most.all.x, sum.specular.x),
                       fma(p.sheen_color.y, sheen * most.all.y, sum.specular.y),
                       fma(p.sheen_color.z, sheen * most.all.z, sum.specular.z));
#endif
#elif SHADING == SHADING_BLINN_PHONG
    FV cos2 = most.cosine * most.cosine;
    FV peak = pow_of_cos2(cos2, fv(1.0f) - cos2, fv(1.0f), p.exponent);
    sum.specular = add3(sum.specular, scale3(most.irradiance, peak));
#endif
    return sum;
}

// Relative; more than the rounding of the sums.
#define BOUND_ROUNDING 1e-4f

// Radiance that the surface reflects at most, from bounds of the sums.
SHARED_FN FV3 radiance_bound(Surface s, ShadingPoint p, LightSum most) {
    return scale3(reflected_radiance(s, p, most), fv(1.0f + BOUND_ROUNDING));
}

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
    through = through * p.below_coat;
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

// Radiance of the surface, from the sums over its lights.
SHARED_FN FV3 finish_shading(Surface s, ShadingPoint p, LightSum sum, float ambient) {
    FV3 lit = reflected_radiance(s, p, sum);
    FV3 emissive = s.emissive, albedo = s.albedo;
    FV a = s.occlusion * fv(ambient);
#if HAS_TRANSMISSION
    albedo = scale3(albedo, fv(1.0f) - transmitting_share(s));
#endif
#if HAS_SHEEN_LOBE
    // As of even light from all directions.
    albedo = with_sheen_light(s, p, scale3(albedo, fma(-p.sheen_most, p.sheen.albedo, fv(1.0f))),
                              fv3(p.sheen.albedo, p.sheen.albedo, p.sheen.albedo));
#endif
#if HAS_COAT
    a = a * p.below_coat;
    emissive = scale3(emissive, p.below_coat);
#endif
    return fv3(fma(a, albedo.x, lit.x) + emissive.x, fma(a, albedo.y, lit.y) + emissive.y,
               fma(a, albedo.z, lit.z) + emissive.z);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
