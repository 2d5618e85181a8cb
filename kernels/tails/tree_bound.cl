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

// Errors of light of intensity 1 from a node.
typedef struct NodeError {
    float diffuse;  // of the irradiance
    float share;    // of the intensity, at most
    float cosine;   // n.h at most
    float fresnel;  // f of Schlick's f0 + (1 - f0) f, at most
} NodeError;

// Sets `cosine` and `fresnel` of light within `stray` of the direction l.
static inline NodeError with_highlight_bounds(NodeError e, ShadingPoint p, float3 l, float stray) {
    float3 v = (float3)(p.to_eye.x, p.to_eye.y, p.to_eye.z);
    float3 n = (float3)(p.normal.x, p.normal.y, p.normal.z);
    float3 h = l + v;
    float length_h = sqrt(dot(h, h));
    float rest = length_h - 0.5f * stray;
    float turn = rest > 0.0f ? stray / rest : 2.0f;
    float inv_length = 1.0f / max(length_h, 1e-12f);
    e.cosine = clamp(dot(n, h) * inv_length + turn + 1e-6f, 0.0f, 1.0f);
    float v_dot_h = max(dot(v, h) * inv_length - 0.5f * stray, 0.0f);
    e.fresnel = schlick_rise(1.0f - v_dot_h);
    return e;
}

static inline NodeError node_error(ShadingPoint p, TreeNode node, float4 at) {
    NodeError out = {0.0f, 0.0f, 0.0f, 0.0f};
    float3 w = (float3)(at.x - p.position.x, at.y - p.position.y, at.z - p.position.z);
    float distance = sqrt(dot(w, w));
    float near = distance * (2.0f - TREE_ROUNDING) - node.radius * TREE_ROUNDING;
    float along = p.normal.x * w.x + p.normal.y * w.y + p.normal.z * w.z;
    float highest = along;
#if HAS_COAT && HAS_COAT_NORMAL
    highest = max(along, p.coat_normal.x * w.x + p.coat_normal.y * w.y + p.coat_normal.z * w.z);
#endif
    float slack = node.radius * TREE_ROUNDING + 1e-5f * distance;
    if (highest < -slack) return out;  // behind the surface: no part of it is seen
    float inv = 1.0f / near;
    out.share = inv * inv;
    float spread = node.spread * inv;
    bool lit = along > slack;
    float error = lit ? fma(3.0f * spread, spread, 2.0f * node.offset * inv) : 2.0f * spread;
    out.diffuse = out.share * min(error, 1.0f);
#if SHADING != SHADING_LAMBERT
    float stray = node.radius / (distance - 0.5f * node.radius);
    out = with_highlight_bounds(out, p, w / distance, stray);
#if SHADING == SHADING_PBR
    // Fresnel's complement is diffuse: its slope is at most 5 (1 - v.h)^4 / 2.
    float slope = 2.5f * pow(out.fresnel, 0.8f) * TREE_ROUNDING;
    out.diffuse += out.share * min(slope * spread, 1.0f);
#if HAS_SHEEN_LOBE
    // So is what the sheen leaves.
    float fade = p.sheen_most * p.sheen.slope * TREE_ROUNDING;
    out.diffuse += out.share * min(fade * spread, 1.0f);
#endif
#endif
#endif
    return out;
}

kernel void tree_bound(LIT_ARGS,
                       global float* restrict bound) {  // out [3][height][stride]
    BEGIN_CLUSTERED_ROW;
    FV3 out = zero3();
    if (item.any) {
        Surface s = load_surface(g, item.pixels, item.z);
        ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
        LightSum sum = zero_sum();
        FOR_EACH_CLUSTER_OF(item, cluster, mine, active, at.tile) {
            for (uint i = 0; i < clusters[cluster].list_count; ++i) {
                uint light = lists[clusters[cluster].list_begin + i];
                if (light < light_count || !(tree_nodes[light - light_count].radius > 0.0f))
                    continue;
                ShadeLight row = lights[light];
                NodeError e =
                    node_error(p, tree_nodes[light - light_count], row.position_inv_range2);
                FV3 color = fv3(row.color_scale.x, row.color_scale.y, row.color_scale.z);
                FV3 all = scale3(color, e.share);
                LightBound most = {e.cosine, e.fresnel, scale3(color, e.diffuse), all, all};
                sum = add_bounds(sum, s, p, most);
            }
        }
        out = radiance_bound(s, p, sum);
    }
    store_radiance(bound, view, item.pixels, out);
}
