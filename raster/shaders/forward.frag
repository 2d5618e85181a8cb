#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A fragment lit where it is drawn: by every light, or with CLUSTERED by the lights of its coarse
// cluster. SHADING, HAS_SPOT_LIGHTS, HAS_METALLIC, HAS_SPECULAR, HAS_CLEARCOAT, HAS_SHEEN,
// HAS_ANISOTROPY, HAS_TRANSMISSION, HAS_UNLIT, HAS_LIGHT_PROFILES, HAS_AREA_LIGHTS as
// in evaluate.h; HAS_DIRECTIONAL_LIGHTS. BLENDED: the material lets light through.
#include "raster/shaders/surface.glsl"
#include "kernels/shared/evaluate.h"

layout(std140, binding = FORWARD_BLOCK) uniform ForwardBlock { ForwardRow frame; };
layout(std430, binding = 0) readonly buffer DirectionalLights {
    DirectionalLight directional_lights[];
};
// Lights (view space) and lists; LIGHT_TEXTURES: see LightAccess in raster/forward_lights.h.
#if LIGHT_TEXTURES
layout(binding = LIGHTS_UNIT) uniform samplerBuffer lights;  // rows of ShadeLight
layout(binding = CLUSTER_OFFSETS_UNIT) uniform usamplerBuffer cluster_offsets;
layout(binding = LIGHT_LISTS_UNIT) uniform usamplerBuffer light_lists;

ShadeLight light_at(uint light) {
    int row = LIGHT_ROW_COUNT * int(light);
    ShadeLight read;
    read.position_inv_range2 = texelFetch(lights, row++);
    read.color_scale = texelFetch(lights, row++);
#define READ_ROW(has, feature, member) read.member = texelFetch(lights, row++);
    LIGHT_ROWS(READ_ROW)
    return read;
}
uint cluster_offset(uint cluster) { return texelFetch(cluster_offsets, int(cluster)).x; }
uint listed_light(uint entry) { return texelFetch(light_lists, int(entry)).x; }
#else
layout(std430, binding = 1) readonly buffer Lights { ShadeLight lights[]; };
layout(std430, binding = 2) readonly buffer ClusterOffsets { uint cluster_offsets[]; };
layout(std430, binding = 3) readonly buffer LightLists { uint light_lists[]; };

ShadeLight light_at(uint light) { return lights[light]; }
uint cluster_offset(uint cluster) { return cluster_offsets[cluster]; }
uint listed_light(uint entry) { return light_lists[entry]; }
#endif

#if HAS_LIGHT_PROFILES
#if LIGHT_TEXTURES
layout(binding = LIGHT_PROFILES_UNIT) uniform samplerBuffer light_profiles;  // rows of AimedProfile
layout(binding = PROFILE_TABLES_UNIT) uniform samplerBuffer profile_tables;

AimedProfile profile_of_light(LightProfiles from, uint light) {
    AimedProfile read;
    read.down = texelFetch(light_profiles, 2 * int(light));
    read.side = texelFetch(light_profiles, 2 * int(light) + 1);
    return read;
}
float profile_value(LightProfiles from, uint i) { return texelFetch(profile_tables, int(i)).x; }
#else
layout(std430, binding = 4) readonly buffer AimedProfiles { AimedProfile light_profiles[]; };
layout(std430, binding = 5) readonly buffer ProfileTables { float profile_tables[]; };

AimedProfile profile_of_light(LightProfiles from, uint light) { return light_profiles[light]; }
float profile_value(LightProfiles from, uint i) { return profile_tables[i]; }
#endif
float profile_head(LightProfiles from, uint i) { return profile_value(from, i); }
#endif

#if HAS_AREA_LIGHTS
#if LIGHT_TEXTURES
layout(binding = LIGHT_SHAPES_UNIT) uniform samplerBuffer light_shapes;  // rows of LightShape

LightShape shape_of_light(LightExtras from, uint light) {
    LightShape read;
    read.half_x = texelFetch(light_shapes, 2 * int(light));
    read.half_y = texelFetch(light_shapes, 2 * int(light) + 1);
    return read;
}
#else
layout(std430, binding = 6) readonly buffer LightShapes { LightShape light_shapes[]; };

LightShape shape_of_light(LightExtras from, uint light) { return light_shapes[light]; }
#endif
#endif

layout(location = 0, index = 0) precise out vec4 out_radiance;  // linear
#if BLENDED
layout(location = 0, index = 1) precise out vec4 out_behind;  // the share of the light behind
#endif

// First and end of the fragment's lights in light_lists, or in lights.
uvec2 light_range(float z) {
#if CLUSTERED
    Pixels pixels = fragment_pixels();
    uvec2 tile = uvec2(pixels.x, pixels.y) / uvec2(frame.grid.tile_width, frame.grid.tile_height);
    uint cluster = cluster_index(frame.grid, tile.x, tile.y, slice_of_depth(frame.grid, z));
    return uvec2(cluster_offset(cluster), cluster_offset(cluster + 1u));
#else
    return uvec2(0u, frame.light_count);
#endif
}

// Sums as kernels/shading/shade.cl does: in blocks by light index.
LightSum sum_lights(LightSum total, ShadingPoint p, uvec2 range) {
    RunningSum sum = start_sum(total);
#if HAS_LIGHT_EXTRAS
    LightExtras extras = LightExtras(LightProfiles(0u));
#endif
    for (uint i = range.x; i < range.y; ++i) {
#if CLUSTERED
        uint light = listed_light(i);
#else
        uint light = i;
#endif
        sum = enter_block(sum, light);
        sum.block = EVALUATE(sum.block, p, light_at(light), extras, light);
    }
    return finish_sum(sum);
}

void main() {
    SurfaceScene scene = SurfaceScene(0u);
    Fragment f = drawn_fragment(scene);
    if (!is_covered(scene, f)) discard;
    Surface s = drawn_surface(scene, f);
    ShadingPoint p = make_shading_point(s, camera.view.orthographic != 0u);
    LightSum sum = zero_sum();
#if HAS_DIRECTIONAL_LIGHTS
    for (uint i = 0u; i < frame.directional_count; ++i) {
        sum = evaluate_directional(sum, p, directional_lights[i]);
    }
#endif
    sum = sum_lights(sum, p, light_range(f.z));
    FV3 radiance = finish_shading(s, p, sum, frame.ambient);
#if BLENDED
    float alpha = coverage_of(scene, f.material, f);
    FV3 behind = share_behind(s, p, alpha);
    out_behind = vec4(behind.x, behind.y, behind.z, 0.0);
    radiance = alpha > 0.0 ? scale3(radiance, alpha) : zero3();
#endif
    // Finite, and that of a hundred layers, since OpenGL blends by products: a share of 0 of infinite
    // light would be NaN.
    out_radiance = vec4(min(vec3(radiance.x, radiance.y, radiance.z), vec3(1e36)), 1.0);
}
