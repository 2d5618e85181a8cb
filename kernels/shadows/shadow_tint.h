// SPDX-License-Identifier: Apache-2.0
// The share of a light that passes the surfaces which blend or transmit between it and VW points: a
// product of colours. It is summed as logarithms in integers, so that the order of the surfaces
// changes no bit.
#ifndef KILOLUX_DEVICE_SHADOW_TINT_H
#define KILOLUX_DEVICE_SHADOW_TINT_H
#include "kernels/device/triangle.h"
#include "kernels/shadows/masked_caster.h"
#include "kernels/shadows/shadow_space.h"
#include "kernels/shared/evaluate.h"
#include "kernels/shared/surface_of.h"

// Units of log2; the rounding of a surface's share is 3.4e-7 of it.
#define TINT_UNIT (1.0f / (1 << 20))
// Largest -log2 of a share, of a surface and of all: less light counts as 2^-60.
#define TINT_MOST 60.0f

// -log2 of the share of each channel at VW points, in units.
typedef struct TintSums {
    UV red, green, blue;
} TintSums;

static inline UV tint_units(FV share) {
    FV least = fv(1.0f / (1 << 30)) * (1.0f / (1 << 30));
    FV log2_share = log2_of(min(max(share, least), fv(1.0f)));
    return lane_to_uint(fma(log2_share, fv(-1.0f / TINT_UNIT), fv(0.5f)));
}

static inline UV added_units(UV sum, UV units) {
    return min(sum + units, (UV)((uint)(TINT_MOST / TINT_UNIT)));
}

static inline FV share_of_units(UV units) {
    return exp2_of_negative(lane_to_float(units) * -TINT_UNIT);
}

#if HAS_TEXCOORDS
static inline Footprint tint_footprint(const float* u, const float* v, CasterWeights w) {
    Footprint at;
    at.u = weighted(u, w);
    at.v = weighted(v, w);
    at.u_dx = at.v_dx = at.u_dy = at.v_dy = fv(0.0f);  // textures' finest level
    return at;
}
#endif

// The attributes of a caster at the weights of its corners; normals are the triangle's.
static inline Fragment tint_fragment(const TintCaster* caster, CasterWeights w, FV3 normal) {
    Fragment f = no_fragment();
    f.normal = normal;
#if HAS_TRANSMISSION
    f.scale = fv(fabs(caster->scale));
#endif
#if HAS_TEXCOORD0
    f.texcoord0 = tint_footprint(caster->u0, caster->v0, w);
#endif
#if HAS_TEXCOORD1
    f.texcoord1 = tint_footprint(caster->u1, caster->v1, w);
#endif
#if HAS_VERTEX_COLOR
    f.color.x = weighted(caster->red, w);
    f.color.y = weighted(caster->green, w);
    f.color.z = weighted(caster->blue, w);
    f.color.w = weighted(caster->alpha, w);
#endif
    return f;
}

// Rays that may pass a triangle.
typedef struct TintRay {
    FV u[3];  // forms of its edges: at least 0 inside
    CasterWeights weights;
    FV3 to_light;  // of any length
} TintRay;

// The lanes inside the edge from a to b, whose form is u, or on it where the triangle owns it. The
// form of the triangle beyond is exactly -u, and its edge runs from b to a, so that one of the two
// counts the point. At a vertex none or several may.
static inline MASK inside_edge(FV u, float3 a, float3 b) {
    bool owns = a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    return owns ? lane_mask(u >= fv(0.0f)) : lane_mask(u > fv(0.0f));
}

// Adds the surface of a caster at the points `passed`. A material of one side tints only
// light that reaches its front.
static inline TintSums add_surface(TintSums sums, MaskedScene masked, global const float* casters,
                                   global const TintCaster* of, TintRay ray, MASK passed) {
    TintCaster caster = *of;
    global const float* corners = casters + (ulong)caster.triangle * 9u;
    float3 a = vload3(0, corners), b = vload3(1, corners), c = vload3(2, corners);
    passed &=
        inside_edge(ray.u[0], b, c) & inside_edge(ray.u[1], c, a) & inside_edge(ray.u[2], a, b);
    if (!lane_any(passed)) return sums;
    FV3 to_light = ray.to_light;
    CasterWeights w = ray.weights;
    float3 n = unit_or_zero(cross_fma(b - a, c - a));
    MaterialRef material = masked.materials + caster.material;
    FV3 normal = fv3(fv(n.x), fv(n.y), fv(n.z));
    FV facing = dot3(normal, to_light);
    if ((material->flags & MATERIAL_DOUBLE_SIDED) == 0u) {
        passed &= lane_mask(facing * caster.scale > fv(0.0f));
        if (!lane_any(passed)) return sums;
    }
    normal = scale3(normal, lane_select(lane_mask(facing < fv(0.0f)), fv(-1.0f), fv(1.0f)));
    SurfaceScene scene;
    scene.materials = masked.materials;
    scene.textures = masked.textures.rows;
    scene.texels = masked.textures.texels;
    Fragment f = tint_fragment(&caster, w, normal);
    const Textures maps = textures_of(scene, material, &f);
    Surface s = surface_of_material(&maps, &f);
    s.position = scale3(to_light, fv(-1.0f));
    FV3 share = share_behind(s, make_shading_point(s, false), coverage_of(scene, material, &f));
    sums.red = select(sums.red, added_units(sums.red, tint_units(share.x)), passed);
    sums.green = select(sums.green, added_units(sums.green, tint_units(share.y)), passed);
    sums.blue = select(sums.blue, added_units(sums.blue, tint_units(share.z)), passed);
    return sums;
}
#endif
