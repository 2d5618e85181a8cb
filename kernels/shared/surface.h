// SPDX-License-Identifier: Apache-2.0
// A point on a surface, and the values that shading with any light needs of it.
//
// Compile-time switches: SHADING, HAS_METALLIC, HAS_SPECULAR (KHR_materials_ior and
// KHR_materials_specular), HAS_CLEARCOAT (KHR_materials_clearcoat), HAS_COAT_NORMAL,
// HAS_SHEEN (KHR_materials_sheen), HAS_ANISOTROPY (ggx.h), HAS_TRANSMISSION
// (KHR_materials_transmission), HAS_UNLIT, HAS_AREA_LIGHTS (lights with a size). Features that the
// scene lacks are not compiled in; compiling them in changes no bit of the radiance, but for
// HAS_COAT_NORMAL in G-buffers that store normals otherwise than the coat's plane does.
#ifndef KILOLUX_SHARED_SURFACE_H
#define KILOLUX_SHARED_SURFACE_H
#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/lobes/ggx.h"
#include "kernels/shared/lobes/sheen.h"
#include "kernels/shared/types.h"

#ifndef SHADING
#define SHADING SHADING_LAMBERT
#endif
#ifndef HAS_MATERIAL
#define HAS_MATERIAL 0
#endif
#ifndef HAS_OCCLUSION
#define HAS_OCCLUSION 0
#endif
#ifndef HAS_METALLIC
#define HAS_METALLIC 0
#endif
#ifndef HAS_SPECULAR
#define HAS_SPECULAR 0
#endif
#ifndef HAS_CLEARCOAT
#define HAS_CLEARCOAT 0
#endif
// Whether coats may have other normals than the surfaces below them.
#ifndef HAS_COAT_NORMAL
#define HAS_COAT_NORMAL HAS_CLEARCOAT
#endif
#ifndef HAS_SHEEN
#define HAS_SHEEN 0
#endif
#ifndef HAS_TRANSMISSION
#define HAS_TRANSMISSION 0
#endif
// Whether the G-buffer may hold unlit surfaces: is_lit().
#ifndef HAS_UNLIT
#define HAS_UNLIT 0
#endif
// Whether shading points have what lights with a size need.
#ifndef HAS_AREA_LIGHTS
#define HAS_AREA_LIGHTS 0
#endif
#if HAS_AREA_LIGHTS
#include "kernels/shared/area/area_lobe.h"
#endif
#define F0_VARIES (HAS_METALLIC || HAS_SPECULAR)
// Clear coats and sheen are parts of glTF's model alone.
#define HAS_COAT (HAS_CLEARCOAT != 0 && SHADING == SHADING_PBR)
#define HAS_SHEEN_LOBE (HAS_SHEEN != 0 && SHADING == SHADING_PBR)

#if defined(__cplusplus)
namespace kilolux {
#endif

SHARED_FN FV3 zero3() { return fv3(fv(0.0f), fv(0.0f), fv(0.0f)); }

SHARED_FN FV largest_channel(FV3 c) { return max(max(c.x, c.y), c.z); }

#define MEMBER_VECTOR(has, member, decoded, plane, value) FV3 member;
#define MEMBER_SCALAR(has, member, decoded, plane, value) FV member;
// A point on a surface, in view space.
SHARED_PLAIN_STRUCT(Surface) {
    FV3 position;  // [m]
    FV3 normal;    // unit
    SURFACE_VALUES(MEMBER_VECTOR, MEMBER_SCALAR)
};

// A surface at the origin of view space with the normal +z and the default of each row of
// SURFACE_VALUES; so are background pixels.
SHARED_FN Surface default_surface() {
    Surface s;
    s.position = zero3();
    s.normal = fv3(fv(0.0f), fv(0.0f), fv(1.0f));
#define DEFAULT_VECTOR(has, member, decoded, plane, value) \
    s.member = fv3(fv(value), fv(value), fv(value));
#define DEFAULT_SCALAR(has, member, decoded, plane, value) s.member = fv(value);
    SURFACE_VALUES(DEFAULT_VECTOR, DEFAULT_SCALAR)
    return s;
}

// Unlit surfaces send their emissive light alone.
SHARED_FN MASK is_lit(Surface s) { return s.roughness > fv(UNLIT_ROUGHNESS); }

// The values of a surface that are the same for all lights.
SHARED_PLAIN_STRUCT(ShadingPoint) {
    FV3 position;
    FV3 normal;
    FV3 to_eye;   // unit
    FV exponent;  // blinn-phong: of cos^2
#if SHADING == SHADING_PBR
    GgxLobe lobe;
#endif
#if F0_VARIES
    FV3 f0;  // pbr: reflectance head on
#endif
#if HAS_SPECULAR
    FV f90;           // pbr: reflectance at grazing angles
    FV diffuse_loss;  // pbr: share of diffuse light lost at grazing angles, relative to head on
#endif
#if HAS_COAT
    FV3 coat_normal;
    GgxLobe coat;
    FV coat_share;
    FV below_coat;  // share of light that the coat leaves to the surface below it
#endif
#if HAS_SHEEN_LOBE
    SheenLobe sheen;
    FV3 sheen_color;  // the colour times sheen.scale and below_coat
    FV sheen_most;    // the largest channel of its colour
#endif
#if HAS_AREA_LIGHTS
    AreaFrame frame;
#if SHADING == SHADING_PBR
    AreaLobe area;
#endif
#if HAS_COAT
    AreaFrame coat_frame;
    AreaLobe coat_area;
#endif
#endif
};

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

// Head-on loss of diffuse light: the reflectance of the strongest channel, so that a tinted one
// does not colour the rest (KHR_materials_specular, implementation).
SHARED_FN FV3 diffuse_f0(Surface s) {
    FV most = largest_channel(dielectric_f0(s));
    return mixed_f0(s, fv3(most, most, most));
}

#if HAS_COAT
// KHR_materials_clearcoat, fresnel_coat(): the coat's share depends on the eye's direction alone.
SHARED_FN ShadingPoint with_coat(ShadingPoint p, Surface s) {
    p.coat_normal = s.coat_normal;
    p.coat = make_ggx_lobe(s.coat_normal, p.to_eye, s.coat_roughness);
    FV f = schlick_rise(fv(1.0f) - p.coat.n_dot_v);
    p.coat_share = s.coat * fma(fv(1.0f) - f, fv(DIELECTRIC_F0), f);
    p.below_coat = fv(1.0f) - p.coat_share;
    return p;
}
#endif

#if HAS_AREA_LIGHTS
SHARED_FN ShadingPoint with_area_lobes(ShadingPoint p) {
    p.frame = make_area_frame(p.normal, p.to_eye);
#if SHADING == SHADING_PBR
#if HAS_ANISOTROPY
    p.area = stretched_area_lobe(p.lobe, p.frame);
#else
    p.area = make_area_lobe(p.lobe, p.lobe.alpha);
#endif
#endif
#if HAS_COAT
    p.coat_frame = make_area_frame(p.coat_normal, p.to_eye);
    p.coat_area = make_area_lobe(p.coat, p.coat.alpha);
#endif
    return p;
}
#endif

SHARED_FN ShadingPoint make_shading_point(Surface s, bool orthographic) {
    ShadingPoint p;
    p.position = s.position;
    p.normal = s.normal;
    p.to_eye = zero3();
    p.exponent = fv(0.0f);
#if SHADING != SHADING_LAMBERT
    p.to_eye = fv3(fv(0.0f), fv(0.0f), fv(1.0f));
    if (!orthographic) {
        // 1e-30: a point at the eye itself has no direction to it.
        FV inv_distance = lane_rsqrt(max(dot3(s.position, s.position), fv(1e-30f)));
        p.to_eye = scale3(s.position, -inv_distance);
    }
#endif
#if SHADING == SHADING_BLINN_PHONG
    FV alpha = clamped_alpha(s.roughness);
    p.exponent = fv(1.0f) / (alpha * alpha) - fv(1.0f);
#elif SHADING == SHADING_PBR
    p.lobe = make_ggx_lobe(s.normal, p.to_eye, s.roughness);
#if HAS_ANISOTROPY
    p.lobe = stretched_lobe(p.lobe, p.to_eye, s.tangent, s.anisotropy);
#endif
#endif
#if F0_VARIES
    p.f0 = mixed_f0(s, dielectric_f0(s));
#endif
#if HAS_SPECULAR
    FV lost = fv(1.0f) - s.specular_f90;
    p.f90 = fma(s.metallic - fv(1.0f), lost, fv(1.0f));
    FV kept = lost / max(fv(1.0f) - largest_channel(s.specular), fv(1e-6f));
    p.diffuse_loss = fv(1.0f) - min(kept, fv(1.0f));
#endif
#if HAS_COAT
    p = with_coat(p, s);
#endif
#if HAS_SHEEN_LOBE
    p.sheen = make_sheen_lobe(p.lobe.n_dot_v, s.sheen_roughness);
    p.sheen_most = largest_channel(s.sheen);
    p.sheen_color = scale3(s.sheen, p.sheen.scale);
#if HAS_COAT
    p.sheen_color = scale3(p.sheen_color, p.below_coat);
#endif
#endif
#if HAS_AREA_LIGHTS
    p = with_area_lobes(p);
#endif
    return p;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
