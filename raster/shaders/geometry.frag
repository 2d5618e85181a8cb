#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A fragment's material to the G-buffer. GBUFFER_LAYOUT names the layout. MATERIAL_LOCATION,
// OCCLUSION_LOCATION, SPECULAR_LOCATION and GRAZING_LOCATION are those of the optional attachments,
// where HAS_<name> is 1 (host: gbuffer_targets.cpp).
#include "kernels/shared/gbuffer.h"
#include "raster/shaders/material.glsl"

layout(location = 7) uniform float emissive_scale_inv;
#if GBUFFER_LAYOUT == GBUFFER_HALF
layout(location = 8) uniform mat4x3 world_from_view;
const float HALF_MAX = 65504.0;

// Rounded to nearest, since some drivers cut off when they store; and finite.
vec3 rounded_to_half(vec3 v) {
    vec3 finite = clamp(v, -HALF_MAX, HALF_MAX);
    return vec3(unpackHalf2x16(packHalf2x16(finite.xy)), unpackHalf2x16(packHalf2x16(finite.zz)).x);
}
#endif

#if GBUFFER_LAYOUT == GBUFFER_OCT_2X4
// 8 bits a channel, red lowest, as the value of a float: its bits would be a denormal number, which
// hardware may flush to zero.
float albedo_number(vec3 albedo) {
    return float(packUnorm4x8(vec4(albedo, 0.0)));
}
#endif

#if GBUFFER_LAYOUT == GBUFFER_PACKED || GBUFFER_LAYOUT == GBUFFER_NORMAL_XY
layout(location = 0) out vec2 out_normal;  // UNORM of [-1, 1]
layout(location = 1) out vec4 out_albedo;  // sRGB by the framebuffer; roughness
#elif GBUFFER_LAYOUT == GBUFFER_FULL
layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_albedo;
layout(location = 3) out vec3 out_parameters;  // roughness, metallic, occlusion
#elif GBUFFER_LAYOUT == GBUFFER_HALF
layout(location = 0) out vec3 out_position;  // world space
layout(location = 1) out vec3 out_normal;    // world space
layout(location = 2) out vec4 out_albedo;    // linear; roughness
#elif GBUFFER_LAYOUT == GBUFFER_OCT_2X4
layout(location = 0) out vec4 out_row_0;
layout(location = 1) out vec4 out_row_1;
#endif
#if HAS_MATERIAL_LOCATION
layout(location = MATERIAL_LOCATION) out vec4 out_material;  // emissive, metallic
#endif
#if HAS_OCCLUSION_LOCATION
layout(location = OCCLUSION_LOCATION) out float out_occlusion;
#endif
#if HAS_SPECULAR_LOCATION
layout(location = SPECULAR_LOCATION) out vec4 out_specular;
#endif
#if HAS_GRAZING_LOCATION
layout(location = GRAZING_LOCATION) out float out_grazing;
#endif

void main() {
    MaterialSample s = sample_material();
    vec3 albedo = s.base_color.rgb;
#if GBUFFER_LAYOUT == GBUFFER_PACKED
    FV3 octahedral = octahedral_encode(fv3(s.normal.x, s.normal.y, s.normal.z));
    out_normal = vec2(octahedral.x, octahedral.y) * 0.5 + 0.5;
    out_albedo = vec4(albedo, s.roughness);
#elif GBUFFER_LAYOUT == GBUFFER_NORMAL_XY
    out_normal = s.normal.xy * 0.5 + 0.5;
    out_albedo = vec4(albedo, s.roughness);
#elif GBUFFER_LAYOUT == GBUFFER_FULL
    out_position = v_position;
    out_normal = s.normal;
    out_albedo = albedo;
    out_parameters = vec3(s.roughness, s.metallic, s.occlusion);
#elif GBUFFER_LAYOUT == GBUFFER_HALF
    out_position = rounded_to_half(world_from_view * vec4(v_position, 1.0));
    out_normal = rounded_to_half(world_from_view * vec4(s.normal, 0.0));
    out_albedo = vec4(albedo, s.roughness);
#elif GBUFFER_LAYOUT == GBUFFER_OCT_2X4
    FV3 octahedral = octahedral_encode(fv3(s.normal.x, s.normal.y, s.normal.z));
    out_row_0 = vec4(v_position, albedo_number(albedo));
    out_row_1 = vec4(octahedral.x, octahedral.y, s.roughness, s.metallic);
#endif
#if HAS_MATERIAL_LOCATION
#if GBUFFER_LAYOUT == GBUFFER_FULL
    out_material = vec4(s.emissive, 0.0);
#else
    out_material = vec4(s.emissive * emissive_scale_inv, s.metallic);
#endif
#endif
#if HAS_SPECULAR_LOCATION
#if HAS_GRAZING_LOCATION
    out_specular = vec4(s.specular.rgb, 0.0);
    out_grazing = s.specular.a;
#else
    out_specular = vec4(sqrt(s.specular.rgb), s.specular.a);
#endif
#endif
#if HAS_OCCLUSION_LOCATION
    out_occlusion = s.occlusion;
#endif
}
