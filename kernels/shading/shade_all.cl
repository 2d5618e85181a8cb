// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel from every light: the reference that lists must not change by a bit.
// One work-item shades VW neighbouring pixels of a row. A work-group lies within one fine tile;
// with STAGE > 0 it is a whole one.
#define ALL_LIGHTS 1
#include "kernels/device/gbuffer.h"
#include "kernels/shading/light_target.h"
#include "kernels/shading/sum_lights.h"

kernel void shade_all(
    global const uchar* restrict gbuffer, GBufferLayout layout, View view,
    global const float* restrict srgb,                           // [256]
    global const DirectionalLight* restrict directional_lights,  // [directional_count], view space
    uint directional_count,
    global const StoredLight* restrict lights,  // [light_count], view space
#if HAS_LIGHT_PROFILES
    global const AimedProfile* restrict aimed_profiles,  // [light_count], view space
    global const float* restrict profile_tables,
#endif
    uint light_count, float ambient,
#if SHADOWS
    ShadowView shadow, global const float* restrict origins, global const float4* restrict bounds,
    global const ShadowNode* restrict nodes, global const float* restrict casters,
    global const MaskedCaster* restrict masked_casters,
    global const SurfaceMaterial* restrict materials, global const TextureRow* restrict textures,
    global const ulong* restrict texels,
#endif
#if SAMPLED_SHADOWS
    global const float* restrict whole,  // [3][height][stride]: radiance if all lights are seen
    float rays, uint seed,
    global float* restrict variance,  // out [height][stride]: of the luminance, its estimate
#endif
    global float* restrict radiance) {  // out [3][height][stride]
    LightTarget to = {radiance};
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    bool inside = y < view.height;
    LightSet set;
    set.lights = lights;
#if HAS_LIGHT_PROFILES
    set.profiles = (LightProfiles){aimed_profiles, profile_tables};
#endif
#if STAGE > 0
    local ShadeLight staged_lights[STAGE];
    local uint staged_indices[STAGE];
    set.staged = staged_lights;
    set.staged_indices = staged_indices;
#else
    if (!inside) return;
#endif
    uint row = inside ? y : view.height - 1u;  // rows below the image only help to stage
    GBuffer g = {gbuffer, layout, view, srgb};
    prefetch_next_tile(g, to, x, row);
    Pixels pixels = row_pixels(view, x, row);
    FV depth01 = load_depth01(g, pixels);
    MASK drawn = lane_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    bool any_drawn = inside && lane_any(drawn);
#if STAGE == 0
    if (!any_drawn) {
        store_light(to, view, pixels, zero3());
        return;
    }
#endif
    FV z = view_depth(view, pixels.x, pixels.y, lane_select(drawn, depth01, fv(1.0f)));
    Surface s = load_surface(g, pixels, z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
#if SHADOWS
    ShadowPoints points;
    set.shadows.scene =
        (ShadowScene){nodes, casters, {masked_casters, materials, {textures, texels}}, shadow};
    set.shadows.points = &points;
    set.shadows.drawn = drawn;
    set.shadows.bounds = bounds;
    set.shadows.directional = directional_lights;
    load_origins(&points, 0u, origins, view.stride * view.height, pixels);
#endif
#if SAMPLED_SHADOWS
    FV spread = fv(0.0f);
    set.variance = &spread;
    set.draw = make_draw(s, whole, view, pixels, x, row, rays, seed);
#endif
    LightSum sum = sum_directional(p, set, directional_lights, directional_count);
    sum = sum_lights(sum, any_drawn, p, set, 0, light_count);
#if SAMPLED_SHADOWS
    FV3 color = without_hidden(set.draw, load_radiance(whole, view, pixels), sum);
#else
    FV3 color = finish_shading(s, sum, ambient);
#endif
    if (inside) store_light(to, view, pixels, select3(drawn, color, zero3()));
#if SAMPLED_SHADOWS
    if (inside) store_plane(variance, pixels, lane_select(drawn, spread, fv(0.0f)));
#endif
}
