// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel from every light: the reference that shading by lists must equal bit for
// bit. One work-item shades VW neighbouring pixels of a row. A work-group lies within one fine
// tile;
// with STAGE > 0 it is a whole one.
#define ALL_LIGHTS 1
#include "kernels/device/lit_item.h"
#include "kernels/shading/light_target.h"
#include "kernels/shading/sum_lights.h"

kernel void shade_all(GBUFFER_ARGS, LIGHT_ARGS(const), SHADOW_ARGS, SAMPLE_ARGS, OUTPUT_ARGS) {
    GBuffer g = GBUFFER_OF_ARGS;
    LightTarget to = LIGHT_TARGET_OF_ARGS;
    ItemPlace at = place_in_planes(view);
    LightSet set = light_set(lights, aimed_profiles, profile_tables);
#if STAGE > 0
    local ShadeLight staged_lights[STAGE];
    local uint staged_indices[STAGE];
    set.staged = staged_lights;
    set.staged_indices = staged_indices;
#else
    if (!at.inside) return;
#endif
    uint row = at.inside ? at.y : view.height - 1u;  // rows below the image only help to stage
    prefetch_next_tile(g, to, at.x, row);
    LitItem item = lit_item(g, row_pixels(view, at.x, row));
    bool any_shown = at.inside && item.any;
#if STAGE == 0
    if (!any_shown) {
        store_light(to, view, item.pixels, zero3());
        return;
    }
#endif
    Surface s = load_surface(g, item.pixels, item.z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
#if SHADOWS
    ShadowPoints points;
    set.shadows.scene = SHADOW_SCENE_OF_ARGS;
    set.shadows.points = &points;
    set.shadows.wanted = item.shown;
    set.shadows.bounds = bounds;
    set.shadows.directional = directional_lights;
    load_origins(&points, 0u, origins, view.stride * view.height, item.pixels);
#endif
#if SAMPLED_SHADOWS
    FV spread = fv(0.0f);
    set.variance = &spread;
    set.pick = make_pick(s, whole, view, item.pixels, at.x, row, rays, seed);
#endif
    LightSum sum = sum_directional(p, set, directional_lights, directional_count);
    sum = sum_lights(sum, any_shown, p, set, 0, light_count);
#if SAMPLED_SHADOWS
    FV3 color = without_hidden(set.pick, load_radiance(whole, view, item.pixels), sum);
    if (at.inside) store_plane(variance, item.pixels, lane_select(item.shown, spread, fv(0.0f)));
#else
    FV3 color = finish_shading(s, sum, ambient);
#endif
    if (at.inside) store_light(to, view, item.pixels, select3(item.shown, color, zero3()));
}
