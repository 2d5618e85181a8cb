// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel from every light: the reference that shading by lists must equal bit for
// bit. One work-item shades VW neighbouring pixels of a row.
#define ALL_LIGHTS 1
#include "kernels/device/lit_item.h"
#include "kernels/shading/sum_lights.h"

// All lights.
typedef struct LightSource {
    uint count;
    global const DirectionalLight* directional;
    uint directional_count;
#if SHADOWS
    global const float* origins;
    ShadowScene casters;
    global const TintCaster* tint_casters;
#endif
} LightSource;

static inline bool has_lights(LightSource from, uint tile) { return true; }

static inline LitItem source_item(LightSource from, GBuffer g, uint x, uint y) {
    return lit_item(g, row_pixels(g.view, x, y));
}

static inline LightSum source_sum(LightSource from, GBuffer g, ItemPlace at, LitItem item,
                                  bool wanted, ShadingPoint p, LightSet set) {
#if SHADOWS
    ShadowPoints points;
    set.shadows.scene = from.casters;
    set.shadows.points = &points;
    set.shadows.wanted = item.shown;
    set.directional = from.directional;
    load_origins(&points, 0u, from.origins, g.view.stride * g.view.height, item.pixels);
    load_area_pixels(&points, 0u, g, item.pixels);
#endif
#if TINTED_SHADOWS
    set.tints.scene = tinting_scene(from.casters, from.tint_casters);
    set.tints.points = &points;
#endif
    LightSum sum = sum_directional(p, set, from.directional, from.directional_count);
    return sum_lights(sum, wanted, p, set, 0, from.count);
}

#include "kernels/shading/shade_item.h"

kernel void shade_all(GBUFFER_ARGS, LIGHT_ARGS(const), SHADOW_ARGS, SAMPLE_ARGS, OUTPUT_ARGS) {
    LIGHT_SET_OF_ARGS(set);
    LightSource from = {light_count, directional_lights, directional_count};
#if SHADOWS
    from.origins = origins;
    from.casters = SHADOW_SCENE_OF_ARGS;
    from.tint_casters = tint_casters;
#endif
    shade_item(GBUFFER_OF_ARGS, from, set, SHADE_OUTPUT_OF_ARGS);
}
