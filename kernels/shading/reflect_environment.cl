// SPDX-License-Identifier: Apache-2.0
// Adds an environment's light to the lit surfaces: diffuse light from a map of irradiance, specular
// light from maps prefiltered by roughness, times the reflectance of a table (Karis 2013, "Real
// Shading in Unreal Engine 4", split sum). One work-item takes VW neighbouring pixels of a row.
#include "kernels/device/lit_item.h"
#include "kernels/device/radiance.h"
#include "kernels/shading/environment.h"
#include "kernels/shared/lobes/passed_light.h"
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

// What a lobe reflects.
typedef struct LobeLight {
    FV3 light;
    FV3 shares;  // of table_at()
} LobeLight;

#if HAS_ANISOTROPY
// Half vectors along the tangent of a stretched lobe, and alpha of the narrow lobes about them by
// their distance (tuned: tests/measure/reflections_test.cpp).
#define STRETCHED_SAMPLES 9
#define STRETCHED_WIDTH 0.3f

// The share of the light that a lobe reflects about the half vector h: 4 V v.h n.l / n.h.
static inline FV share_about(ShadingPoint p, FV3 h, FV n_dot_h, FV v_dot_h) {
    FV3 l = sub3(scale3(h, 2.0f * v_dot_h), p.to_eye);
    FV n_dot_l = max(dot3(p.normal, l), fv(0.0f));
    FV smith_l = stretched_smith(p.lobe, n_dot_l, dot3(p.lobe.tangent, l));
    FV smith = fma(n_dot_l, p.lobe.smith_v, p.lobe.n_dot_v * smith_l);
    return 2.0f * v_dot_h * n_dot_l / (smith * n_dot_h);
}

// A stretched lobe as narrow ones about half vectors along the tangent, at even quantiles of GGX's
// slopes without those across. Each is as wide as the slopes that it stands for.
static inline LobeLight stretched(ReflectionMaps maps, View view, Surface s, ShadingPoint p,
                                  LobeLight isotropic) {
    FV across = clamped_alpha(s.roughness), one = fv(1.0f);
    FV width = (one - across) * s.anisotropy * s.anisotropy;  // what is added to `across`
    FV3 sum = zero3();
    FV total = fv(0.0f), rise = fv(0.0f);
    for (int k = 0; k < STRETCHED_SAMPLES; ++k) {
        float u = (float)(2 * k + 1 - STRETCHED_SAMPLES) / STRETCHED_SAMPLES;
        float stretch = 1.0f / sqrt(1.0f - u * u);
        FV slope = width * (u * stretch);
        FV n_dot_h = one / lane_sqrt(fma(slope, slope, one));
        FV3 h = scale3(add3(s.normal, scale3(s.tangent, slope)), n_dot_h);
        FV v_dot_h = max(dot3(p.to_eye, h), fv(0.0f));
        FV share = share_about(p, h, n_dot_h, v_dot_h);
        FV alpha = width * (STRETCHED_WIDTH * stretch * stretch * stretch / STRETCHED_SAMPLES);
        FV roughness = lane_sqrt(min(max(alpha, across), one));
        sum = add3(sum, scale3(lobe_light(maps, view, h, p.to_eye, roughness), share));
        total += share;
        rise = fma(share, schlick_rise(one - v_dot_h), rise);
    }
    LobeLight out;
    out.light = scale3(sum, one / max(total, fv(1e-6f)));
    // The table's shares, changed as those of these half vectors change without strength.
    FV n_dot_v = p.lobe.n_dot_v, count = fv((float)STRETCHED_SAMPLES);
    FV smith = lane_sqrt(smith_square(p.lobe, n_dot_v));
    FV ratio = total * smith / (n_dot_v * count);
    FV more = fma(-total, schlick_rise(one - n_dot_v), rise) / count;
    out.shares = isotropic.shares;
    out.shares.y = max(fma(isotropic.shares.y, ratio, more), fv(0.0f));
    out.shares.x =
        max(fma(isotropic.shares.x + isotropic.shares.y, ratio, -out.shares.y), fv(0.0f));
    MASK is_stretched = lane_mask(s.anisotropy > fv(0.0f));
    out.light = select3(is_stretched, out.light, isotropic.light);
    out.shares = select3(is_stretched, out.shares, isotropic.shares);
    return out;
}
#endif

static inline FV3 reflected(ReflectionMaps maps, View view, Surface s, FV3 irradiance) {
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    LobeLight lobe;
    lobe.shares = table_at(maps, p.lobe.n_dot_v, s.roughness);
    lobe.light = lobe_light(maps, view, s.normal, p.to_eye, s.roughness);
#if HAS_ANISOTROPY
    lobe = stretched(maps, view, s, p, lobe);
#endif
    FV3 shares = lobe.shares, light = lobe.light;
    FV f90 = fv(1.0f);
#if HAS_SPECULAR
    f90 = p.f90;
#endif
#if F0_VARIES
    FV3 f0 = p.f0;
#else
    FV3 f0 = dielectric_f0(s);
#endif
    FV3 diffuse = diffuse_albedo(s, diffuse_share(p, shares.z));
    FV rise = f90 * shares.y;
    FV3 out = fv3(fma(fma(f0.x, shares.x, rise), light.x, diffuse.x * irradiance.x),
                  fma(fma(f0.y, shares.x, rise), light.y, diffuse.y * irradiance.y),
                  fma(fma(f0.z, shares.x, rise), light.z, diffuse.z * irradiance.z));
    // The sheen's wide lobe has less error with the diffuse light than with a prefiltered mirror
    // direction.
    out = with_even_sheen(s, p, out, irradiance);
#if HAS_COAT
    FV3 of_coat = table_at(maps, p.coat.n_dot_v, s.coat_roughness);
    FV3 coat = lobe_light(maps, view, s.coat_normal, p.to_eye, s.coat_roughness);
    FV share = p.coat_share * (of_coat.x + of_coat.y);
    out = fv3(fma(out.x, p.below_coat, coat.x * share), fma(out.y, p.below_coat, coat.y * share),
              fma(out.z, p.below_coat, coat.z * share));
#endif
    return out;
}
#else
static inline FV3 reflected(ReflectionMaps maps, View view, Surface s, FV3 irradiance) {
    FV3 albedo = even_albedo(s);
    return fv3(albedo.x * irradiance.x, albedo.y * irradiance.y, albedo.z * irradiance.z);
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
