// SPDX-License-Identifier: Apache-2.0
// Shading of a work-item's pixels, whatever lights reach them. A kernel includes this after its
//   LightSource     where it takes lights from
//   has_lights()    whether any may reach a tile
//   source_item()   the pixels of the work-item at (x, y) of the planes
//   source_sum()    the sum of their light; without `wanted` the work-item only helps to stage
// A work-group lies within one fine tile.
#ifndef KILOLUX_DEVICE_SHADE_ITEM_H
#define KILOLUX_DEVICE_SHADE_ITEM_H
#include "kernels/device/lit_item.h"
#include "kernels/shading/light_target.h"
#include "kernels/shading/sum_lights.h"

// SAMPLE_ARGS and OUTPUT_ARGS.
typedef struct ShadeOutput {
    LightTarget to;
    float ambient;
    ShadowSamples samples;
    global float* variance;
} ShadeOutput;
#define SHADE_OUTPUT_OF_ARGS \
    ((ShadeOutput){LIGHT_TARGET_OF_ARGS, ambient, SAMPLES_OF_ARGS, variance})

static inline void shade_item(GBuffer g, LightSource from, LightSet set, ShadeOutput out) {
    View view = g.view;
    ItemPlace at = place_in_planes(view);
    bool inside = at.inside;
#if STAGE == 0
    if (!inside) return;
#endif
    if (!inside) at.y = view.height - 1u;  // rows below the planes only help to stage
    prefetch_next_tile(g, out.to, at.x, at.y);
    if (!has_lights(from, at.tile)) {  // background, for the whole group
        if (inside) store_darkness(out.to, view, row_pixels(view, at.x, at.y));
        return;
    }
    LitItem item = source_item(from, g, at.x, at.y);
    bool wanted = inside && item.any;
#if STAGE == 0
    if (!wanted) {
        store_darkness(out.to, view, item.pixels);
        return;
    }
#endif
    Surface s = load_surface(g, item.pixels, item.z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
#if SAMPLED_SHADOWS
    FV spread = fv(0.0f);
    set.variance = &spread;
    set.pick = make_pick(s, p, out.samples, view, item.pixels, at);
#endif
#if MARK_CANDIDATES
    set.candidates.per_term = luminance_per_term(s, p);
    set.candidates.rays = out.samples.rays;
    set.candidates.tile = tile_key(view, out.samples.seed, at.x, at.y);
#endif
#if LIGHT_GROUPS
    FV3 groups[1 + LIGHT_GROUPS];
    for (uint i = 1u; i <= LIGHT_GROUPS; ++i) groups[i] = zero3();
    set.groups = groups;
    set.surface = &s;
    set.point = &p;
#endif
    LightSum sum = source_sum(from, g, at, item, wanted, p, set);
#if SAMPLED_SHADOWS
    FV3 color = without_hidden(set.pick, load_radiance(out.samples.whole, view, item.pixels), sum);
    if (inside) store_plane(out.variance, item.pixels, lane_select(item.shown, spread, fv(0.0f)));
#else
    FV3 color = finish_shading(s, p, sum, out.ambient);
#endif
    if (!inside) return;
    store_light(out.to, view, item.pixels, select3(item.shown, color, zero3()));
#if LIGHT_GROUPS
    for (uint i = 1u; i <= LIGHT_GROUPS; ++i) {
#if SAMPLED_SHADOWS
        FV3 whole = load_radiance(out.samples.whole + group_planes(view, i), view, item.pixels);
        FV3 lit = sub3(whole, groups[i]);
#else
        FV3 lit = groups[i];
#endif
        store_group_light(out.to, view, i, item.pixels, select3(item.shown, lit, zero3()));
    }
#endif
}
#endif
