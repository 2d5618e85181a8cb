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
// HAS_LIGHT_EXTRAS, where lights may have photometric webs or a size: then evaluate() takes their
// rows and the light's index. The macro EVALUATE takes them in any case, and drops them where there
// are none; ILLUMINANCE, with SHADING_LAMBERT, where the illuminance of surfaces takes the place of
// their radiance: the sum over lights of intensity * falloff * n.l [lx], and nothing else.
#ifndef KILOLUX_SHARED_EVALUATE_H
#define KILOLUX_SHARED_EVALUATE_H
#include "kernels/shared/light.h"
#include "kernels/shared/lobes/light_sum.h"
#include "kernels/shared/lobes/passed_light.h"
#include "kernels/shared/lobes/pbr.h"
#include "kernels/shared/power.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/types.h"

#ifndef HAS_RANDOM_RANGES
#define HAS_RANDOM_RANGES 0
#endif
#ifndef HAS_LIGHT_PROFILES
#define HAS_LIGHT_PROFILES 0
#endif
#ifndef ILLUMINANCE
#define ILLUMINANCE 0
#endif
#define HAS_LIGHT_EXTRAS (HAS_LIGHT_PROFILES != 0 || HAS_AREA_LIGHTS != 0)
#if HAS_AREA_LIGHTS
#include "kernels/shared/area/area_lobes.h"
#endif
#if HAS_LIGHT_EXTRAS
#include "kernels/shared/light_extras.h"
#define EVALUATE(sum, p, light, extras, index) evaluate(sum, p, light, extras, index)
#else
#define EVALUATE(sum, p, light, extras, index) evaluate(sum, p, light)
#endif

// Returns early for a light whose window is 0 in all lanes, before its costly part. It pays for all
// models but lambert, where the branch costs more than it saves, unless lights have extras.
#ifndef EARLY_OUT
#define EARLY_OUT (SHADING != SHADING_LAMBERT || HAS_LIGHT_EXTRAS)
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

// Adds a light that has a place.
#if HAS_LIGHT_EXTRAS
SHARED_FN LightSum evaluate(LightSum sum, ShadingPoint p, ShadeLight light, LightExtras extras,
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
    window = window * profile_share(extras.profiles, index, v);
#endif
#if HAS_AREA_LIGHTS
    LightShape shape = shape_of_light(extras, index);
    if (has_size(shape)) return add_area_light(sum, p, shape, v, window, light.color_scale);
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

// Radiance that the surface reflects, from the sums over its lights.
SHARED_FN FV3 reflected_radiance(Surface s, ShadingPoint p, LightSum sum) {
#if ILLUMINANCE
    return sum.diffuse;
#else
    FV3 diffuse = diffuse_albedo(s, fv(INV_PI));
#if SHADING == SHADING_LAMBERT
    FV3 out_radiance =
        fv3(diffuse.x * sum.diffuse.x, diffuse.y * sum.diffuse.y, diffuse.z * sum.diffuse.z);
#else
#if SHADING == SHADING_BLINN_PHONG
    FV alpha = clamped_alpha(s.roughness);
    // (n + 2) / (8 pi) with n = 2 / alpha2 - 2: Walter et al. 2007's match of exponent and
    // roughness.
    FV3 lobe = scale3(mixed_f0(s, dielectric_f0(s)), fv(0.25f * INV_PI) / (alpha * alpha));
#else
    FV3 lobe = fv3(fv(0.5f * INV_PI), fv(0.5f * INV_PI), fv(0.5f * INV_PI));
#endif
    FV3 out_radiance = fv3(fma(diffuse.x, sum.diffuse.x, lobe.x * sum.specular.x),
                           fma(diffuse.y, sum.diffuse.y, lobe.y * sum.specular.y),
                           fma(diffuse.z, sum.diffuse.z, lobe.z * sum.specular.z));
#endif
#if HAS_UNLIT
    MASK lit = is_lit(s);
    out_radiance =
        fv3(lane_select(lit, out_radiance.x, fv(0.0f)), lane_select(lit, out_radiance.y, fv(0.0f)),
            lane_select(lit, out_radiance.z, fv(0.0f)));
#endif
    return out_radiance;
#endif
}

// Adds the largest sums that the light can cause.
SHARED_FN LightSum add_bounds(LightSum sum, Surface s, ShadingPoint p, LightBound most) {
#if SHADING == SHADING_PBR
    return add_pbr_bounds(sum, s, p, most);
#else
    sum.diffuse = add3(sum.diffuse, most.diffuse);
#if SHADING == SHADING_BLINN_PHONG
    FV cos2 = most.cosine * most.cosine;
    FV peak = pow_of_cos2(cos2, fv(1.0f) - cos2, fv(1.0f), p.exponent);
    sum.specular = add3(sum.specular, scale3(most.irradiance, peak));
#endif
    return sum;
#endif
}

// Relative; more than the rounding of the sums.
#define BOUND_ROUNDING 1e-4f

// Radiance that the surface reflects at most, from bounds of the sums.
SHARED_FN FV3 radiance_bound(Surface s, ShadingPoint p, LightSum most) {
    return scale3(reflected_radiance(s, p, most), fv(1.0f + BOUND_ROUNDING));
}

// Radiance of the surface, from the sums over its lights.
SHARED_FN FV3 finish_shading(Surface s, ShadingPoint p, LightSum sum, float ambient) {
    FV3 lit = reflected_radiance(s, p, sum);
#if ILLUMINANCE
    return lit;
#else
    FV below = share_below_coat(p), a = s.occlusion * fv(ambient) * below;
    FV3 emissive = scale3(s.emissive, below);
    FV3 albedo = with_even_sheen(s, p, even_albedo(s), fv3(fv(1.0f), fv(1.0f), fv(1.0f)));
    return fv3(fma(a, albedo.x, lit.x) + emissive.x, fma(a, albedo.y, lit.y) + emissive.y,
               fma(a, albedo.z, lit.z) + emissive.z);
#endif
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
