// SPDX-License-Identifier: Apache-2.0
// What one light adds to one shading point: the only place where light meets surface, for the
// OpenCL kernels (VW pixels at once) and for GLSL (one fragment).
//
//   pixel = emissive + ambient * occlusion * albedo + sum over lights of
//           brdf * intensity * falloff * n.l
//   falloff(d) = window(d / range) / max(d, LIGHT_D_MIN)^2,  window(x) = clamp(1 - x^4, 0, 1)
//   (KHR_lights_punctual, "Range Property")
//
// The window is exactly 0 where d >= range, so a light that is listed in vain adds exactly nothing.
// Compile-time switches: SHADING, HAS_SPOT_LIGHTS, HAS_METALLIC, HAS_SPECULAR (KHR_materials_ior
// and KHR_materials_specular), HAS_UNLIT, FAST_RSQRT: what the scene does not need is not in the
// code, and is worth the same bits where it is.
#ifndef KILOLUX_SHARED_EVALUATE_H
#define KILOLUX_SHARED_EVALUATE_H
#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/light.h"
#include "kernels/shared/power.h"
#include "kernels/shared/types.h"

#ifndef SHADING
#define SHADING SHADING_LAMBERT
#endif
#ifndef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 0
#endif
#ifndef HAS_METALLIC
#define HAS_METALLIC 0
#endif
#ifndef HAS_SPECULAR
#define HAS_SPECULAR 0
#endif
// Surfaces of roughness 0 are unlit; lit ones have at least 1/255, which is as narrow a lobe.
#ifndef HAS_UNLIT
#define HAS_UNLIT 0
#endif
#define F0_VARIES (HAS_METALLIC || HAS_SPECULAR)
// Leave a light whose window is 0 in all lanes before its costly part: pays for all but lambert,
// where the branch costs more than it saves.
#ifndef EARLY_OUT
#define EARLY_OUT (SHADING != SHADING_LAMBERT)
#endif

// Whether rsqrt is one instruction (GPUs) rather than a root and a division (CPUs).
#ifndef FAST_RSQRT
#define FAST_RSQRT 0
#endif

// How the one quotient per light is taken; a kernel may define a faster one.
#ifndef DIVIDE
#define DIVIDE(a, b) ((a) / (b))
#endif

// Nearer than this the inverse square stops growing: light sources have a size [m] (Lagarde and de
// Rousiers 2014, "Moving Frostbite to PBR", 3.1: max(d^2, 0.01^2)).
#define LIGHT_D_MIN 0.01f
// Perceptual roughness below which a lobe is too narrow for float32 and 2x16 normals (Filament's
// limit).
#define ROUGHNESS_MIN 0.045f
// Reflectance of dielectrics at normal incidence (glTF 2.0, appendix B).
#define DIELECTRIC_F0 0.04f
// Cosine to the eye below which the surface is seen edge on (Filament, MIN_N_DOT_V).
#define N_DOT_V_MIN 1e-4f
#define INV_PI 0.318309886f
// Lights whose contributions are summed before they join the pixel's sum; by light index, so that a
// light that contributes 0 changes no bit wherever it is listed. Error of k terms: (64 + k/64) u,
// where one running sum has k u (Higham 2002, "Accuracy and Stability of Numerical
// Algorithms", 4.2).
#define SUM_BLOCK_LOG2 6

#if defined(__cplusplus)
namespace kilolux {
#endif

// A point on a surface, in view space.
SHARED_PLAIN_STRUCT(Surface) {
    FV3 position;  // [m]
    FV3 normal;    // unit
    FV3 albedo;    // base colour, linear Rec. 709
    FV3 emissive;  // radiance
    FV roughness;  // perceptual
    FV metallic;
    FV occlusion;
#if HAS_SPECULAR
    FV3 specular;     // reflectance of the dielectric part head on
    FV specular_f90;  // and at grazing angles
#endif
};

// What of a surface is the same for all lights.
SHARED_PLAIN_STRUCT(ShadingPoint) {
    FV3 position;
    FV3 normal;
    FV3 to_eye;    // unit
    FV n_dot_v;    // pbr
    FV alpha2;     // pbr: roughness^4
    FV ggx_slope;  // pbr: (1 - alpha2) / alpha
    FV ggx_floor;  // pbr: alpha
    FV smith_v;    // pbr: sqrt(n.v^2 (1 - alpha2) + alpha2)
    FV exponent;   // blinn-phong: of cos^2
#if F0_VARIES
    FV3 f0;  // pbr: reflectance head on
#endif
#if HAS_SPECULAR
    FV f90;            // pbr: reflectance at grazing angles
    FV diffuse_rises;  // pbr: what diffuse light keeps at grazing angles, relative to head on
#endif
};

// Sums over lights of intensity * falloff * n.l, weighted as each term of the BRDF needs.
SHARED_PLAIN_STRUCT(LightSum) {
    FV3 diffuse;
    FV3 specular;
};

SHARED_FN FV3 zero3() { return fv3(fv(0.0f), fv(0.0f), fv(0.0f)); }

SHARED_FN LightSum zero_sum() {
    LightSum sum;
    sum.diffuse = zero3();
    sum.specular = zero3();
    return sum;
}

SHARED_FN LightSum add_sums(LightSum a, LightSum b) {
    a.diffuse = add3(a.diffuse, b.diffuse);
#if SHADING != SHADING_LAMBERT
    a.specular = add3(a.specular, b.specular);
#endif
    return a;
}

SHARED_FN FV3 add_scaled(FV3 sum, FV weight, float4 color) {
    return fv3(fma(weight, fv(color.x), sum.x), fma(weight, fv(color.y), sum.y),
               fma(weight, fv(color.z), sum.z));
}

SHARED_FN FV clamped_alpha(FV roughness) {
    FV r = max(roughness, fv(ROUGHNESS_MIN));
    return r * r;
}

// Reflectance head on of a surface whose dielectric part has `dielectric`.
SHARED_FN FV3 mixed_f0(Surface s, FV3 dielectric) {
#if HAS_METALLIC
    FV rest = fv(1.0f) - s.metallic;
    return fv3(fma(s.albedo.x, s.metallic, rest * dielectric.x),
               fma(s.albedo.y, s.metallic, rest * dielectric.y),
               fma(s.albedo.z, s.metallic, rest * dielectric.z));
#else
    return dielectric;
#endif
}

SHARED_FN FV3 dielectric_f0(Surface s) {
#if HAS_SPECULAR
    return s.specular;
#else
    return fv3(fv(DIELECTRIC_F0), fv(DIELECTRIC_F0), fv(DIELECTRIC_F0));
#endif
}

// What diffuse light loses head on: the strongest channel's reflectance, so that a tinted one does
// not colour the rest (KHR_materials_specular, implementation).
SHARED_FN FV3 diffuse_f0(Surface s) {
    FV3 f0 = dielectric_f0(s);
    FV most = max(max(f0.x, f0.y), f0.z);
    return mixed_f0(s, fv3(most, most, most));
}

SHARED_FN ShadingPoint make_shading_point(Surface s, bool orthographic) {
    ShadingPoint p;
    p.position = s.position;
    p.normal = s.normal;
    p.to_eye = zero3();
    p.n_dot_v = fv(0.0f);
    p.alpha2 = fv(0.0f);
    p.ggx_slope = fv(0.0f);
    p.ggx_floor = fv(0.0f);
    p.smith_v = fv(0.0f);
    p.exponent = fv(0.0f);
#if SHADING != SHADING_LAMBERT
    FV alpha = clamped_alpha(s.roughness);
    p.alpha2 = alpha * alpha;
    p.ggx_slope = (fv(1.0f) - p.alpha2) / alpha;
    p.ggx_floor = alpha;
    p.to_eye = fv3(fv(0.0f), fv(0.0f), fv(1.0f));
    if (!orthographic) {
        // 1e-30: a point at the eye itself has no direction to it.
        FV inv_distance = rsqrt(max(dot3(s.position, s.position), fv(1e-30f)));
        p.to_eye = scale3(s.position, -inv_distance);
    }
#endif
#if SHADING == SHADING_BLINN_PHONG
    p.exponent = fv(1.0f) / p.alpha2 - fv(1.0f);
#elif SHADING == SHADING_PBR
    p.n_dot_v = max(dot3(s.normal, p.to_eye), fv(N_DOT_V_MIN));
    p.smith_v = sqrt(fma(p.n_dot_v * p.n_dot_v, fv(1.0f) - p.alpha2, p.alpha2));
#endif
#if F0_VARIES
    p.f0 = mixed_f0(s, dielectric_f0(s));
#endif
#if HAS_SPECULAR
    FV lost = fv(1.0f) - s.specular_f90;
    p.f90 = fma(s.metallic - fv(1.0f), lost, fv(1.0f));
    FV most = max(max(s.specular.x, s.specular.y), s.specular.z);
    p.diffuse_rises = min(lost / max(fv(1.0f) - most, fv(1e-6f)), fv(1.0f));
#endif
    return p;
}

#if SHADING == SHADING_BLINN_PHONG
// Light of `lit` = intensity's weight * falloff * n.l from the direction `v`, `distance` long.
SHARED_FN LightSum add_blinn_phong(LightSum sum, ShadingPoint p, FV3 v, FV distance, FV lit,
                                   float4 color) {
    // The half vector, `distance` times as long: that saves normalising v before it is needed.
    FV3 h = fv3(fma(p.to_eye.x, distance, v.x), fma(p.to_eye.y, distance, v.y),
                fma(p.to_eye.z, distance, v.z));
    FV hh = max(dot3(h, h), fv(1e-30f));  // light from straight behind the view has none
    FV n_dot_h = dot3(p.normal, h);
    // |n x h|^2 keeps the lobe that n.h rounds away at large exponents.
    FV3 nxh = cross3(p.normal, h);
    FV lobe = pow_of_cos2(n_dot_h * n_dot_h, dot3(nxh, nxh), hh, p.exponent);
    lobe = select_fv(n_dot_h > fv(0.0f), lobe, fv(0.0f));
    sum.diffuse = add_scaled(sum.diffuse, lit, color);
    sum.specular = add_scaled(sum.specular, lit * lobe, color);
    return sum;
}

#elif SHADING == SHADING_PBR
// Light of `lit` = intensity's weight * falloff * n.l from the unit direction `v` * `inv_length`.
SHARED_FN LightSum add_pbr(LightSum sum, ShadingPoint p, FV3 v, FV inv_length, FV n_dot_l, FV lit,
                           float4 color) {
    FV3 h = fv3(fma(v.x, inv_length, p.to_eye.x), fma(v.y, inv_length, p.to_eye.y),
                fma(v.z, inv_length, p.to_eye.z));
    // 1e-12: light from straight behind the view has no half vector, only rounding of one (1e-7
    // long).
    FV hh = max(dot3(h, h), fv(1e-12f));
    // Lagrange's identity |n x h|^2 = h^2 - (n.h)^2 keeps narrow lobes (Filament, 4.4.1). Both
    // sides of D's fraction are multiplied by h^2, which saves normalising h, and divided by alpha,
    // so that the peak of a mirror keeps the size it has in the end.
    FV3 nxh = cross3(p.normal, h);
    FV ggx = fma(dot3(nxh, nxh), p.ggx_slope, p.ggx_floor * hh);
    FV smith_l = sqrt(fma(n_dot_l * n_dot_l, fv(1.0f) - p.alpha2, p.alpha2));
    FV smith = fma(n_dot_l, p.smith_v, p.n_dot_v * smith_l);
    // D * V without its constant 1 / (2 pi), which finish_shading multiplies in.
    FV lobe = DIVIDE(lit * (hh * hh), ggx * ggx * smith);
    FV schlick = max(fma(-dot3(p.to_eye, h), rsqrt(hh), fv(1.0f)), fv(0.0f));
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
    sum.specular = fv3(fma(lobe * fma(g, p.f0.x, f), fv(color.x), sum.specular.x),
                       fma(lobe * fma(g, p.f0.y, f), fv(color.y), sum.specular.y),
                       fma(lobe * fma(g, p.f0.z, f), fv(color.z), sum.specular.z));
#else
    sum.specular = add_scaled(sum.specular, lobe * fma(g, fv(DIELECTRIC_F0), f), color);
#endif
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

// Adds a point or spot light.
SHARED_FN LightSum evaluate(LightSum sum, ShadingPoint p, ShadeLight light) {
    FV3 v = fv3(fv(light.position_inv_range2.x) - p.position.x,
                fv(light.position_inv_range2.y) - p.position.y,
                fv(light.position_inv_range2.z) - p.position.z);
    FV d2 = dot3(v, v);
    FV x = d2 * fv(light.position_inv_range2.w);
    FV window = max(fma(-x, x, fv(1.0f)), fv(0.0f));
#if EARLY_OUT
    if (!any_of(window > fv(0.0f))) return sum;
#endif
    FV e2 = max(d2, fv(LIGHT_D_MIN * LIGHT_D_MIN));
    FV n_dot_v = max(dot3(p.normal, v), fv(0.0f));  // n.l times the distance
#if SHADING == SHADING_PBR || FAST_RSQRT
    FV inv_d = rsqrt(e2);
#if HAS_SPOT_LIGHTS
    window = window * cone_of(v, inv_d, light);
#endif
    FV n_dot_l = n_dot_v * inv_d;
    FV lit = window * (inv_d * inv_d) * n_dot_l;
#else
    // One root and one division, and no product more than they need.
    FV distance = sqrt(e2);
#if HAS_SPOT_LIGHTS
    window = window * cone_of(v, fv(1.0f) / distance, light);
#endif
    FV lit = DIVIDE(window * n_dot_v, e2 * distance);
#endif
#if SHADING == SHADING_PBR
    return add_pbr(sum, p, v, inv_d, n_dot_l, lit, light.color_scale);
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
    return add_pbr(sum, p, to_light, fv(1.0f), n_dot_l, n_dot_l, light.color);
#elif SHADING == SHADING_BLINN_PHONG
    return add_blinn_phong(sum, p, to_light, fv(1.0f), n_dot_l, light.color);
#else
    sum.diffuse = add_scaled(sum.diffuse, n_dot_l, light.color);
    return sum;
#endif
}

// Radiance of the surface from the sums over its lights.
SHARED_FN FV3 finish_shading(Surface s, LightSum sum, float ambient) {
    FV3 albedo = s.albedo;
    FV k = fv(INV_PI);
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
    MASK lit = s.roughness > fv(0.0f);
    out_radiance =
        fv3(select_fv(lit, out_radiance.x, fv(0.0f)), select_fv(lit, out_radiance.y, fv(0.0f)),
            select_fv(lit, out_radiance.z, fv(0.0f)));
#endif
    FV a = s.occlusion * fv(ambient);
    return fv3(fma(a, albedo.x, out_radiance.x) + s.emissive.x,
               fma(a, albedo.y, out_radiance.y) + s.emissive.y,
               fma(a, albedo.z, out_radiance.z) + s.emissive.z);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
