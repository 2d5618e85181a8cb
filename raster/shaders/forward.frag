#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A fragment lit where it is drawn: by every light, or with CLUSTERED by the lights of its coarse
// cluster. SHADING, HAS_SPOT_LIGHTS, HAS_METALLIC, HAS_SPECULAR, HAS_UNLIT as in evaluate.h; HAS_DIRECTIONAL_LIGHTS.
#include "kernels/shared/evaluate.h"
#include "raster/shaders/material.glsl"

layout(std140, binding = 1) uniform ForwardBlock { ForwardRow frame; };
layout(std430, binding = 0) readonly buffer DirectionalLights {
    DirectionalLight directional_lights[];
};
// Buffer textures, not storage buffers: see raster/forward_lights.h.
layout(binding = LIGHT_ROWS_UNIT) uniform samplerBuffer light_rows;  // ShadeLight, view space
#ifdef CLUSTERED
layout(binding = CLUSTER_OFFSETS_UNIT) uniform usamplerBuffer cluster_offsets;
layout(binding = LIGHT_LISTS_UNIT) uniform usamplerBuffer light_lists;
#endif

layout(location = 0) out vec4 out_radiance;  // linear; alpha for materials that blend

// In the picture, of which the target may hold a band.
vec2 fragment_pixel() {
    return vec2(gl_FragCoord.x, gl_FragCoord.y + float(frame.view.first_row));
}

// Where the deferred renderer finds the fragment too: from pixel and depth, not from a varying.
float depth_of_fragment() {
    vec2 pixel = fragment_pixel();
    return view_depth(frame.view, pixel.x, pixel.y, gl_FragCoord.z);
}

Surface surface_of(MaterialSample m, float z) {
    Surface s;
    vec2 pixel = fragment_pixel();
    s.position = view_position(frame.view, pixel.x, pixel.y, z);
    s.normal = fv3(m.normal.x, m.normal.y, m.normal.z);
    s.albedo = fv3(m.base_color.r, m.base_color.g, m.base_color.b);
    s.emissive = fv3(m.emissive.r, m.emissive.g, m.emissive.b);
    s.roughness = m.roughness;
    s.metallic = m.metallic;
    s.occlusion = m.occlusion;
#if HAS_SPECULAR
    s.specular = fv3(m.specular.r, m.specular.g, m.specular.b);
    s.specular_f90 = m.specular.a;
#endif
    return s;
}

// First and end of the fragment's lights in light_lists, or in lights.
uvec2 light_range(float z) {
#ifdef CLUSTERED
    uvec2 tile = uvec2(fragment_pixel()) / uvec2(frame.grid.tile_width, frame.grid.tile_height);
    uint cluster = cluster_index(frame.grid, tile.x, tile.y, slice_of_depth(frame.grid, z));
    return uvec2(texelFetch(cluster_offsets, int(cluster)).x,
                 texelFetch(cluster_offsets, int(cluster) + 1).x);
#else
    return uvec2(0u, frame.light_count);
#endif
}

ShadeLight light_at(uint light) {
    int row = 3 * int(light);
    ShadeLight out_light;
    out_light.position_inv_range2 = texelFetch(light_rows, row);
    out_light.color_scale = texelFetch(light_rows, row + 1);
#if HAS_SPOT_LIGHTS
    out_light.axis_cos = texelFetch(light_rows, row + 2);
#endif
    return out_light;
}

// Blocked by light index as in kernels/shade.cl, so that a light that adds nothing changes nothing.
LightSum sum_lights(LightSum total, ShadingPoint p, uvec2 range) {
    LightSum block = zero_sum();
    uint current = 0u;
    for (uint i = range.x; i < range.y; ++i) {
#ifdef CLUSTERED
        uint light = texelFetch(light_lists, int(i)).x;
#else
        uint light = i;
#endif
        if (light >> SUM_BLOCK_LOG2 != current) {
            current = light >> SUM_BLOCK_LOG2;
            total = add_sums(total, block);
            block = zero_sum();
        }
        block = evaluate(block, p, light_at(light));
    }
    return add_sums(total, block);
}

void main() {
    MaterialSample m = sample_material();
    float z = depth_of_fragment();
    Surface s = surface_of(m, z);
    ShadingPoint p = make_shading_point(s, frame.view.orthographic != 0u);
    LightSum sum = zero_sum();
#ifdef HAS_DIRECTIONAL_LIGHTS
    for (uint i = 0u; i < frame.directional_count; ++i) {
        sum = evaluate_directional(sum, p, directional_lights[i]);
    }
#endif
    sum = sum_lights(sum, p, light_range(z));
    FV3 radiance = finish_shading(s, sum, frame.ambient);
    out_radiance = vec4(radiance.x, radiance.y, radiance.z, m.base_color.a);
}
