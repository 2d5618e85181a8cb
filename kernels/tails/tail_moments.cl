// SPDX-License-Identifier: Apache-2.0
// Sums the light that the ranges of lights without one of their own take from each coarse cluster,
// as moments: see kernels/tails/tail_moments.h. For the bound of a picture's error; no part of a
// frame otherwise. One work-item sums for VW clusters, over all lights in their order.
#include "kernels/device/arguments.h"
#include "kernels/device/lanes.h"
#include "kernels/shared/surface.h"
#include "kernels/tails/tail_moments.h"

// Boxes of VW clusters: middle and half edges [m].
typedef struct Boxes {
    FV3 middle, half_edge;
    FV radius;  // half the diagonal
} Boxes;

static inline float2 interval_of(global const float2* ends) {
    return (float2)(0.5f * (ends->x + ends->y), 0.5f * (ends->y - ends->x));
}

static inline Boxes load_boxes(ClusterGrid grid, uint first, global const float2* columns,
                               global const float2* rows, global const float2* depths) {
    float m[3][VW], h[3][VW], r[VW];
    for (uint i = 0; i < VW; ++i) {
        uint cluster = min(first + i, grid.cluster_count - 1u);
        uint slice = cluster / (grid.tiles_x * grid.tiles_y);
        uint row = cluster / grid.tiles_x;  // of all slices
        float2 x = interval_of(columns + slice * grid.tiles_x + cluster % grid.tiles_x);
        float2 y = interval_of(rows + row);
        float2 z = interval_of(depths + slice);
        m[0][i] = x.x;
        m[1][i] = y.x;
        m[2][i] = -z.x;
        h[0][i] = x.y;
        h[1][i] = y.y;
        h[2][i] = z.y;
        r[i] = sqrt(x.y * x.y + y.y * y.y + z.y * z.y);
    }
    Boxes out;
    out.middle = fv3(lane_load(m[0]), lane_load(m[1]), lane_load(m[2]));
    out.half_edge = fv3(lane_load(h[0]), lane_load(h[1]), lane_load(h[2]));
    out.radius = lane_load(r);
    return out;
}

// How one light's lost part reaches the boxes.
typedef struct LostLight {
    FV share;    // of its intensity: the most that is lost anywhere in the box [1/m^2]
    FV3 toward;  // l; 0 where s >= 1
    FV stray;    // s, at most 1
} LostLight;

static inline FV square_of(FV v) { return v * v; }

#if HAS_AREA_LIGHTS
// The most that is lost of a light whose points are up to `size` from its centre: their distance
// is less than that of the centre by as much. Where that is more than half of it, the light is at
// most that of the hemisphere, pi over the area.
static inline FV lost_share(LightShape shape, FV near2, FV far2, FV inv) {
    float size = length(shape.half_x.xyz) + length(shape.half_y.xyz);
    FV nearest = max(sqrt(near2) - size, fv(1e-18f));
    float size2 = size * size;
    FV close = fv(16.0f * M_PI_F * shape.half_y.w * size2 * size2) * inv * inv;
    FV within = fma(fv(4.0f) * min(far2 * inv, fv(1.0f)), inv, close);
    return lane_select(near2 * inv > fv(1.0f), fv(1.0f) / (nearest * nearest), within);
}
#endif

// Within the range the window takes d^2 / range^4, beyond it all of 1 / d^2: the most at the range.
static inline LostLight lost_light(Boxes boxes, ShadeLight light, LightShape shape) {
    float4 at = light.position_inv_range2;
    FV3 v = fv3(fv(at.x) - boxes.middle.x, fv(at.y) - boxes.middle.y, fv(at.z) - boxes.middle.z);
    FV near2 = square_of(max(fabs(v.x) - boxes.half_edge.x, fv(0.0f))) +
               square_of(max(fabs(v.y) - boxes.half_edge.y, fv(0.0f))) +
               square_of(max(fabs(v.z) - boxes.half_edge.z, fv(0.0f)));
    FV far2 = square_of(fabs(v.x) + boxes.half_edge.x) + square_of(fabs(v.y) + boxes.half_edge.y) +
              square_of(fabs(v.z) + boxes.half_edge.z);
    LostLight out;
    FV inv = fv(at.w);
    FV within = min(far2 * inv, fv(1.0f)) * inv;
    out.share = lane_select(near2 * inv > fv(1.0f), fv(1.0f) / near2, within);
#if HAS_AREA_LIGHTS
    if (has_size(shape)) out.share = lost_share(shape, near2, far2, inv);
#endif
    // |a/|a| - b/|b|| <= |a - b| / sqrt(|a| |b|)
    FV distance = sqrt(dot3(v, v));
    FV s = boxes.radius / max(sqrt(sqrt(near2) * distance), fv(1e-30f));
    MASK aimed = lane_mask(s < fv(1.0f));
    FV scale = lane_select(aimed, fv(1.0f) / max(distance, fv(1e-30f)), fv(0.0f));
    out.stray = lane_select(aimed, s, fv(1.0f));
    out.toward = select3(aimed, scale3(v, scale), zero3());
#if HAS_SPOT_LIGHTS
    FV cosine = -fma(out.toward.x, fv(light.axis_cos.x),
                     fma(out.toward.y, fv(light.axis_cos.y), out.toward.z * light.axis_cos.z));
    FV cone = clamp((cosine + out.stray - fv(light.axis_cos.w)) * fv(light.color_scale.w), fv(0.0f),
                    fv(1.0f));
    // Of a flat light the cone is its half-space alone.
#if HAS_AREA_LIGHTS
    if (has_size(shape)) cone = fv(1.0f);
#endif
    out.share *= cone * cone;
#endif
    return out;
}

static inline void add_lost(FV* sums, LostLight lost, float intensity) {
    FV w = lost.share * intensity;
    FV3 l = lost.toward;
    FV aimed = lane_select(lane_mask(lost.stray < fv(1.0f)), w, fv(0.0f));
    sums[TAIL_ALL] += w;
    sums[TAIL_AIMED] += aimed;
    sums[TAIL_STRAY] = fma(w, lost.stray, sums[TAIL_STRAY]);
    FV3 wl = scale3(l, w);
    sums[TAIL_TO] += wl.x;
    sums[TAIL_TO + 1] += wl.y;
    sums[TAIL_TO + 2] += wl.z;
    sums[TAIL_OUTER] = fma(wl.x, l.x, sums[TAIL_OUTER]);
    sums[TAIL_OUTER + 1] = fma(wl.y, l.y, sums[TAIL_OUTER + 1]);
    sums[TAIL_OUTER + 2] = fma(wl.z, l.z, sums[TAIL_OUTER + 2]);
    sums[TAIL_OUTER + 3] = fma(wl.x, l.y, sums[TAIL_OUTER + 3]);
    sums[TAIL_OUTER + 4] = fma(wl.x, l.z, sums[TAIL_OUTER + 4]);
    sums[TAIL_OUTER + 5] = fma(wl.y, l.z, sums[TAIL_OUTER + 5]);
}

static inline bool any_occupied(global const uchar* occupied, uint first, uint end) {
    for (uint i = first; i < end; ++i) {
        if (occupied[i]) return true;
    }
    return false;
}

kernel void tail_moments(
    global const Light* restrict own,  // [light_count]: which have no range of their own
    LIGHT_ARGS(const), BOX_ARGS(const),
    global const uchar* restrict occupied,  // [cluster_count]
    global float* restrict moments) {       // out [cluster_count][TAIL_ROWS], where occupied
    uint first = (uint)get_global_id(0) * VW;
    uint end = min(first + VW, grid.cluster_count);
    if (first >= end || !any_occupied(occupied, first, end)) return;
    Boxes boxes = load_boxes(grid, first, columns, rows, depths);
    FV sums[3][TAIL_MOMENTS];
    for (uint c = 0; c < 3; ++c) {
        for (uint i = 0; i < TAIL_MOMENTS; ++i) sums[c][i] = fv(0.0f);
    }
    for (uint i = 0; i < light_count; ++i) {
        if (has_own_range(own[i])) continue;
        LightShape shape = {0.0f, 0.0f};
#if HAS_AREA_LIGHTS
        shape = shapes[i];
#endif
        LostLight lost = lost_light(boxes, lights[i], shape);
        float4 color = lights[i].color_scale;
        add_lost(sums[0], lost, color.x);
        add_lost(sums[1], lost, color.y);
        add_lost(sums[2], lost, color.z);
    }
    for (uint c = 0; c < 3; ++c) {
        for (uint i = 0; i < TAIL_MOMENTS; ++i) {
            float lanes[VW];
            lane_store(sums[c][i], lanes);
            for (uint j = first; j < end; ++j) {
                moments[j * TAIL_ROWS + c * TAIL_MOMENTS + i] = lanes[j - first];
            }
        }
    }
}
