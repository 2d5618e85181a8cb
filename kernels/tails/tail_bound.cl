// SPDX-License-Identifier: Apache-2.0
// Bounds the radiance that each pixel lacks since lights without a range got one, from the moments
// of its coarse cluster (tail_moments). One work-item bounds one pixel: VW is 1.
//
// Of the light from directions l with weights w, the surface takes sum w max(n.l, 0) = sum w (|n.l|
// + n.l) / 2, and sum w |n.l| <= sqrt(sum w * sum w (n.l)^2) by Cauchy and Schwarz. Directions
// stray by s within a cluster, which adds sum w s.
#include "kernels/device/lit_item.h"
#include "kernels/device/radiance.h"
#include "kernels/lists/coarse_tile.h"
#include "kernels/shared/evaluate.h"
#include "kernels/tails/tail_moments.h"

// More than the rounding of the sums of moments.
#define ROUNDING 1.0001f

// sum of w max(n.l, 0) of one colour, at most.
static inline float irradiance_bound(global const float* m, FV3 n) {
    global const float* to = m + TAIL_TO;
    global const float* outer = m + TAIL_OUTER;
    float along = n.x * to[0] + n.y * to[1] + n.z * to[2];
    float square = n.x * n.x * outer[0] + n.y * n.y * outer[1] + n.z * n.z * outer[2] +
                   2.0f * (n.x * n.y * outer[3] + n.x * n.z * outer[4] + n.y * n.z * outer[5]);
    float both = sqrt(m[TAIL_AIMED] * max(square, 0.0f));
    // Rounding may have changed the difference by as much as its terms.
    return 0.5f * (both + along) + (ROUNDING - 1.0f) * m[TAIL_AIMED] + m[TAIL_STRAY];
}

// An upper bound of the radiance of one colour from light of which `all` is the sum of weights and
// `irradiance` the part that the surface receives; `f0` head on: of dielectrics, or mixed.
static inline float radiance_bound(Surface s, ShadingPoint p, float albedo, float f0, float all,
                                   float irradiance) {
#if SHADING == SHADING_LAMBERT
    return albedo * INV_PI * irradiance;
#else
    float base = albedo;
#if HAS_METALLIC
    base *= 1.0f - s.metallic;
#endif
#if SHADING == SHADING_BLINN_PHONG
    float alpha = clamped_alpha(s.roughness);
    return (base * INV_PI + f0 * 0.25f * INV_PI / (alpha * alpha)) * irradiance;
#else
    // GGX: D <= 1 / (pi alpha^2), n.l V <= 1 / (2 sqrt(n.v^2 (1 - alpha^2) + alpha^2)), F <= 1.
    return base * INV_PI * irradiance + 0.5f * INV_PI / (p.alpha2 * p.smith_v) * all;
#endif
#endif
}

kernel void tail_bound(GBUFFER_ARGS, ClusterGrid grid,
                       global const float* restrict moments,  // [cluster_count][TAIL_ROWS]
                       global float* restrict bound) {        // out [3][height][stride]
    BEGIN_ROW;
    if (!item.any) {
        store_radiance(bound, view, item.pixels, zero3());
        return;
    }
    Surface s = load_surface(g, item.pixels, item.z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    CoarseTile tile = coarse_tile(view, grid, at.tile);
    uint cluster = cluster_index(grid, tile.column, tile.row, slice_of_depth(grid, item.z));
    global const float* m = moments + cluster * TAIL_ROWS;
    FV3 f0 = mixed_f0(s, dielectric_f0(s));
    const float albedo[3] = {s.albedo.x, s.albedo.y, s.albedo.z};
    const float f0_of[3] = {f0.x, f0.y, f0.z};
    float out[3];
    for (uint c = 0; c < 3; ++c) {
        global const float* sums = m + c * TAIL_MOMENTS;
        float irradiance = irradiance_bound(sums, s.normal);
        out[c] = ROUNDING * radiance_bound(s, p, albedo[c], f0_of[c], sums[TAIL_ALL], irradiance);
#if HAS_UNLIT
        if (!is_lit(s)) out[c] = 0.0f;
#endif
    }
    store_radiance(bound, view, item.pixels, fv3(out[0], out[1], out[2]));
}
