// SPDX-License-Identifier: Apache-2.0
// Adds an environment's light to the lit surfaces: diffuse light from a map of irradiance, specular
// light from maps prefiltered by roughness, times the reflectance of a table (Karis 2013, "Real
// Shading in Unreal Engine 4", split sum). One work-item takes VW neighbouring pixels of a row.
#include "kernels/device/lit_item.h"
#include "kernels/device/radiance.h"
#include "kernels/shading/environment.h"
#include "kernels/shared/surface.h"

// The maps by levels, and the table.
typedef struct ReflectionMaps {
    global const float* texels;
    global const uint4* levels;  // [roughness_levels + 1]: width, height, first texel; the last one
                                 // is the irradiance / pi
    uint roughness_levels;       // of equal steps from 0 to 1
    global const float* table;   // [table_size][table_size][3]: by n.v and roughness from 0 to 1
    uint table_size;
} ReflectionMaps;

// ReflectionBuffers of host/stages/shading/reflect_environment.h.
#define REFLECTION_ARGS                                                       \
    global const float *restrict texels, global const uint4 *restrict levels, \
        uint roughness_levels, global const float *restrict table, uint table_size

#if SHADING == SHADING_PBR
// A level of each lane: lanes go one by one where their levels differ.
static inline FV3 level_rgb(ReflectionMaps maps, FV3 d, UV level) {
    FV3 out = zero3();
    for (uint i = 0; i < maps.roughness_levels; ++i) {
        MASK mine = lane_mask(level == lane_uint(i));
        if (!lane_any(mine)) continue;
        out = select3(mine, filtered_rgb(maps.texels, texels_towards(d, maps.levels[i])), out);
    }
    return out;
}

// Light from around the direction `d` for a lobe of this roughness.
static inline FV3 prefiltered(ReflectionMaps maps, FV3 d, FV roughness) {
    FV place = roughness * (float)(maps.roughness_levels - 1u);
    FV lower = min(floor(place), fv((float)(maps.roughness_levels - 2u)));
    UV level = lane_to_uint(lower);
    FV share = place - lower;
    FV3 a = level_rgb(maps, d, level);
    FV3 b = level_rgb(maps, d, level + 1u);
    return fv3(fma(share, b.x - a.x, a.x), fma(share, b.y - a.y, a.y), fma(share, b.z - a.z, a.z));
}

// Shares of the light that a surface returns: f0's, f90's, and what diffuse light loses to
// Schlick's rise.
static inline FV3 table_at(ReflectionMaps maps, FV n_dot_v, FV roughness) {
    FV last = fv((float)(maps.table_size - 1u));
    FV x = min(n_dot_v, fv(1.0f)) * last;
    FV y = min(roughness, fv(1.0f)) * last;
    FV left = min(floor(x), last - 1.0f), top = min(floor(y), last - 1.0f);
    MapTexels t;
    t.right = x - left;
    t.down = y - top;
    t.upper_left = lane_to_uint(top) * maps.table_size + lane_to_uint(left);
    t.upper_right = t.upper_left + 1u;
    t.lower_left = t.upper_left + maps.table_size;
    t.lower_right = t.lower_left + 1u;
    return filtered_rgb(maps.table, t);
}

// The direction that most of a lobe's light comes from: the mirror's, for rough surfaces nearer to
// the normal (Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", 4.9.3). 1 - alpha^2 has half
// the error of their weight at roughness 0.25, and like errors above. Of any length.
static inline FV3 lobe_direction(FV3 normal, FV3 to_eye, FV roughness) {
    FV alpha = clamped_alpha(roughness);
    FV share = fma(-alpha, alpha, fv(1.0f));
    FV along = 2.0f * dot3(normal, to_eye) * share + (fv(1.0f) - share);
    return fv3(fma(along, normal.x, -share * to_eye.x), fma(along, normal.y, -share * to_eye.y),
               fma(along, normal.z, -share * to_eye.z));
}

// The light of a lobe about `normal`.
static inline FV3 lobe_light(ReflectionMaps maps, View view, FV3 normal, FV3 to_eye, FV roughness) {
    FV3 lobe = lobe_direction(normal, to_eye, roughness);
    return prefiltered(maps, rotate_to_world(view, lobe), roughness);
}

#if HAS_ANISOTROPY
// KHR_materials_anisotropy, "Image-based lighting": the normal nearer to the plane of the eye and
// the tangent, about which a stretched lobe reflects.
static inline FV3 bent_normal(Surface s, FV3 to_eye) {
    FV3 b = cross3(s.normal, s.tangent), n = s.normal;
    FV along = dot3(b, to_eye);
    FV3 bent =
        fv3(fma(-along, b.x, to_eye.x), fma(-along, b.y, to_eye.y), fma(-along, b.z, to_eye.z));
    bent = scale3(bent, lane_rsqrt(max(dot3(bent, bent), fv(1e-12f))));
    FV a = fma(s.roughness - fv(1.0f), s.anisotropy, fv(1.0f));
    a = (a * a) * (a * a);
    bent = fv3(fma(a, n.x - bent.x, bent.x), fma(a, n.y - bent.y, bent.y),
               fma(a, n.z - bent.z, bent.z));
    bent = scale3(bent, lane_rsqrt(max(dot3(bent, bent), fv(1e-12f))));
    return select3(lane_mask(s.anisotropy > fv(0.0f)), bent, n);
}
#endif

static inline FV3 reflected(ReflectionMaps maps, View view, Surface s, FV3 irradiance) {
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    FV3 normal = s.normal;
#if HAS_ANISOTROPY
    normal = bent_normal(s, p.to_eye);
#endif
    FV3 shares = table_at(maps, p.lobe.n_dot_v, s.roughness);
    FV3 light = lobe_light(maps, view, normal, p.to_eye, s.roughness);
    FV f90 = fv(1.0f), kept = fv(1.0f) - shares.z;
#if HAS_SPECULAR
    f90 = p.f90;
    kept = fma(shares.z, p.diffuse_rises, kept);
#endif
#if F0_VARIES
    FV3 f0 = p.f0;
#else
    FV3 f0 = dielectric_f0(s);
#endif
    FV3 lost = diffuse_f0(s);
    FV base = kept;
#if HAS_METALLIC
    base = kept * (fv(1.0f) - s.metallic);
#endif
    FV rise = f90 * shares.y;
    FV3 out = fv3(fma(fma(f0.x, shares.x, rise), light.x,
                      s.albedo.x * base * (fv(1.0f) - lost.x) * irradiance.x),
                  fma(fma(f0.y, shares.x, rise), light.y,
                      s.albedo.y * base * (fv(1.0f) - lost.y) * irradiance.y),
                  fma(fma(f0.z, shares.x, rise), light.z,
                      s.albedo.z * base * (fv(1.0f) - lost.z) * irradiance.z));
#if HAS_SHEEN_LOBE
    // Its wide lobe has less error with the diffuse light than with a prefiltered mirror direction.
    out = scale3(out, fma(-p.sheen_most, p.sheen.albedo, fv(1.0f)));
    out = with_sheen_light(s, p, out, scale3(irradiance, p.sheen.albedo));
#endif
#if HAS_COAT
    FV3 of_coat = table_at(maps, p.coat.n_dot_v, s.coat_roughness);
    FV3 coat = lobe_light(maps, view, s.coat_normal, p.to_eye, s.coat_roughness);
    out = coated(p, out, scale3(coat, of_coat.x + of_coat.y));
#endif
    return out;
}
#else
static inline FV3 reflected(ReflectionMaps maps, View view, Surface s, FV3 irradiance) {
    return fv3(s.albedo.x * irradiance.x, s.albedo.y * irradiance.y, s.albedo.z * irradiance.z);
}
#endif

kernel void reflect_environment(GBUFFER_ARGS, REFLECTION_ARGS,
                                global float* restrict radiance) {  // in, out [3][height][stride]
    BEGIN_ROW;
    if (!item.any) return;
    Pixels pixels = item.pixels;
    MASK shown = item.shown;
    Surface s = load_surface(g, pixels, item.z);
    ReflectionMaps maps = {texels, levels, roughness_levels, table, table_size};
    MapTexels around = texels_towards(rotate_to_world(view, s.normal), levels[roughness_levels]);
    FV3 added = reflected(maps, view, s, filtered_rgb(texels, around));
#if HAS_UNLIT
    shown &= lane_mask(is_lit(s));
#endif
    uint plane_size = view.stride * view.height;
    FV3 former =
        fv3(lane_load(radiance + pixels.first), lane_load(radiance + plane_size + pixels.first),
            lane_load(radiance + 2 * plane_size + pixels.first));
    FV3 sum = add3(former, scale3(added, s.occlusion));
    store_radiance(radiance, view, pixels, select3(shown, sum, former));
}
