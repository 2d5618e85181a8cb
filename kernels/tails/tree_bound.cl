// SPDX-License-Identifier: Apache-2.0
// Bounds the error of each pixel by nodes of the light tree that replace their lights:
// kernels/tails/tree_cut.h for diffuse light; for a lobe, its maximum over all directions to the
// node's lights. One work-item bounds one pixel: VW is 1.
//
// A direction to a node's light is within `stray` of that to its centre, and the half vector within
// stray / (|h| - stray / 2), h = l + v: |a/|a| - b/|b|| <= 2 |a - b| / (|a| + |b|). The cosine
// v.h moves by at most half as much as l: it is sqrt((1 + l.v) / 2).
#include "kernels/device/lit_item.h"
#include "kernels/device/radiance.h"
#include "kernels/shared/evaluate.h"
#include "kernels/tails/tree_cut.h"

// More than the rounding of the sums.
#define ROUNDING 1.0001f

// Errors of light of intensity 1 from a node.
typedef struct NodeError {
    float diffuse;   // of the irradiance
    float specular;  // bound of its part in a lobe, without constants that LightSum leaves out, too
    float fresnel;   // f of Schlick's f0 + (1 - f0) f, at most
} NodeError;

// The maximum of a lobe within `stray` of the direction l.
static inline float lobe_bound(Surface s, ShadingPoint p, float3 l, float stray, float* fresnel) {
    float3 v = (float3)(p.to_eye.x, p.to_eye.y, p.to_eye.z);
    float3 n = (float3)(p.normal.x, p.normal.y, p.normal.z);
    float3 h = l + v;
    float length_h = sqrt(dot(h, h));
    float rest = length_h - 0.5f * stray;
    float turn = rest > 0.0f ? stray / rest : 2.0f;
    float inv_length = 1.0f / max(length_h, 1e-12f);
    float cosine = min(dot(n, h) * inv_length + turn + 1e-6f, 1.0f);
    float v_dot_h = max(dot(v, h) * inv_length - 0.5f * stray, 0.0f);
    float dark = 1.0f - min(v_dot_h, 1.0f);
    *fresnel = dark * dark * dark * dark * dark;
    if (cosine <= 0.0f) cosine = 0.0f;
#if SHADING == SHADING_PBR
    // D V n.l d^2 without 1 / (2 pi): V n.l <= 1 / (2 smith_v).
    float sine2 = 1.0f - cosine * cosine;
    float ggx = fma(sine2, p.ggx_slope, p.ggx_floor);
    return 1.0f / (ggx * ggx * p.smith_v);
#elif SHADING == SHADING_BLINN_PHONG
    return pow_of_cos2(cosine * cosine, 1.0f - cosine * cosine, 1.0f, p.exponent);
#else
    return 0.0f;
#endif
}

static inline NodeError node_error(Surface s, ShadingPoint p, TreeNode node, float4 at) {
    NodeError out = {0.0f, 0.0f, 0.0f};
    float3 w = (float3)(at.x - p.position.x, at.y - p.position.y, at.z - p.position.z);
    float distance = sqrt(dot(w, w));
    float near = distance * (2.0f - TREE_ROUNDING) - node.radius * TREE_ROUNDING;
    float along = p.normal.x * w.x + p.normal.y * w.y + p.normal.z * w.z;
    float slack = node.radius * TREE_ROUNDING + 1e-5f * distance;
    if (along < -slack) return out;  // behind the surface: no part of it is seen
    float inv = 1.0f / near;
    float share = inv * inv;  // of the intensity, at most
    float spread = node.spread * inv;
    bool lit = along > slack;
    float error = lit ? fma(3.0f * spread, spread, 2.0f * node.offset * inv) : 2.0f * spread;
    out.diffuse = share * min(error, 1.0f);
#if SHADING != SHADING_LAMBERT
    float stray = node.radius / (distance - 0.5f * node.radius);
    out.specular = share * lobe_bound(s, p, w / distance, stray, &out.fresnel);
#if SHADING == SHADING_PBR
    // Fresnel's complement is diffuse: its slope is at most 5 (1 - v.h)^4 / 2.
    float slope = 2.5f * pow(out.fresnel, 0.8f) * TREE_ROUNDING;
    out.diffuse += share * min(slope * spread, 1.0f);
#endif
#endif
    return out;
}

// Error of one colour's radiance for an error `e` at intensity 1.
static inline float radiance_error(Surface s, ShadingPoint p, float albedo, float f0, NodeError e) {
    float base = albedo;
#if HAS_METALLIC
    base *= 1.0f - s.metallic;
#endif
#if SHADING == SHADING_LAMBERT
    return albedo * INV_PI * e.diffuse;
#elif SHADING == SHADING_BLINN_PHONG
    float alpha = clamped_alpha(s.roughness);
    return base * INV_PI * e.diffuse + f0 * 0.25f * INV_PI / (alpha * alpha) * e.specular;
#else
    return base * INV_PI * e.diffuse + 0.5f * INV_PI * (f0 + e.fresnel) * e.specular;
#endif
}

kernel void tree_bound(LIT_ARGS,
                       global float* restrict bound) {  // out [3][height][stride]
    BEGIN_CLUSTERED_ROW;
    float out[3] = {0.0f, 0.0f, 0.0f};
    if (item.any) {
        Surface s = load_surface(g, item.pixels, item.z);
        ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
        FV3 f0 = mixed_f0(s, dielectric_f0(s));
        const float albedo[3] = {s.albedo.x, s.albedo.y, s.albedo.z};
        const float f0_of[3] = {f0.x, f0.y, f0.z};
        FOR_EACH_CLUSTER_OF(item, cluster, mine, active, at.tile) {
            for (uint i = 0; i < clusters[cluster].list_count; ++i) {
                uint light = lists[clusters[cluster].list_begin + i];
                if (light < light_count || !(tree_nodes[light - light_count].radius > 0.0f))
                    continue;
                ShadeLight row = lights[light];
                NodeError e =
                    node_error(s, p, tree_nodes[light - light_count], row.position_inv_range2);
                const float intensity[3] = {row.color_scale.x, row.color_scale.y,
                                            row.color_scale.z};
                for (uint c = 0; c < 3; ++c) {
                    out[c] +=
                        ROUNDING * intensity[c] * radiance_error(s, p, albedo[c], f0_of[c], e);
                }
            }
        }
#if HAS_UNLIT
        if (!is_lit(s)) out[0] = out[1] = out[2] = 0.0f;
#endif
    }
    store_radiance(bound, view, item.pixels, fv3(out[0], out[1], out[2]));
}
