// SPDX-License-Identifier: Apache-2.0
// What a fragment's material is: factors times textures, as glTF 2.0 defines them. A variant has
// the textures whose HAS_*_UV is 1; *_UV is an expression that gives the texture's coordinates.
#include "raster/shaders/draw_rows.h"
#include "raster/shaders/normalize.glsl"

layout(std140, binding = 0) uniform MaterialBlock { MaterialRow material; };

layout(binding = USE_BASE_COLOR) uniform sampler2D base_color_texture;
layout(binding = USE_METALLIC_ROUGHNESS) uniform sampler2D metallic_roughness_texture;
layout(binding = USE_NORMAL) uniform sampler2D normal_texture;
layout(binding = USE_OCCLUSION) uniform sampler2D occlusion_texture;
layout(binding = USE_EMISSIVE) uniform sampler2D emissive_texture;

layout(binding = USE_SPECULAR) uniform sampler2D specular_texture;
layout(binding = USE_SPECULAR_COLOR) uniform sampler2D specular_color_texture;

#if POSITION
layout(location = 0) in vec3 v_position;
#endif
#if SURFACE
layout(location = 1) in vec3 v_normal;
#endif
#if TANGENT
layout(location = 2) in vec4 v_tangent;
#endif
#if TEXCOORD0
layout(location = 3) in vec2 v_texcoord0;
#endif
#if TEXCOORD1
layout(location = 4) in vec2 v_texcoord1;
#endif
#if VERTEX_COLOR
layout(location = 5) in vec4 v_color;
#endif

struct MaterialSample {
    vec4 base_color;  // linear Rec. 709, alpha
    vec3 normal;      // view space, unit
    vec3 emissive;    // linear radiance
    float metallic;
    float roughness;  // perceptual
    float occlusion;
    vec4 specular;  // the dielectric's reflectance head on, and at grazing angles
};

vec2 transformed(int use, vec2 texcoord) {
    vec3 t = vec3(texcoord, 1.0);
    return vec2(dot(material.uv_x[use].xyz, t), dot(material.uv_y[use].xyz, t));
}

vec4 sample_base_color() {
    vec4 color = material.base_color;
#if HAS_BASE_COLOR_UV
    color *= texture(base_color_texture, BASE_COLOR_UV);
#endif
#if VERTEX_COLOR
    color *= v_color;
#endif
    return color;
}

// KHR_materials_specular: min(f0 * colour, 1) * weight, and the weight.
vec4 sample_specular() {
    vec3 f0 = material.specular.xyz;
    float weight = material.specular.w;
#if HAS_SPECULAR_COLOR_UV
    f0 *= texture(specular_color_texture, SPECULAR_COLOR_UV).rgb;
#endif
#if HAS_SPECULAR_UV
    weight *= texture(specular_texture, SPECULAR_UV).a;
#endif
    return vec4(min(f0, vec3(1.0)) * weight, weight);
}

#if SURFACE
vec3 sample_normal() {
    vec3 n = v_normal;
#if HAS_NORMAL_UV
    // MikkTSpace: the basis as interpolated, unnormalised, and the sum normalised.
    vec3 m = texture(normal_texture, NORMAL_UV).xyz * 2.0 - 1.0;
    m.xy *= material.factors.z;
    vec3 bitangent = cross(v_normal, v_tangent.xyz) * v_tangent.w;
    n = m.x * v_tangent.xyz + m.y * bitangent + m.z * v_normal;
#endif
#if DOUBLE_SIDED
    n = gl_FrontFacing ? n : -n;
#endif
    return unit_or_z(n);
}

// Discards a fragment that the alpha mask cuts away, after the textures' derivatives were taken.
MaterialSample sample_material() {
    MaterialSample s;
    s.base_color = sample_base_color();
    s.normal = sample_normal();
    s.emissive = material.emissive_cutoff.xyz;
    s.metallic = material.factors.x;
    s.roughness = material.factors.y;
    s.occlusion = 1.0;
#if HAS_METALLIC_ROUGHNESS_UV
    vec4 packed_maps = texture(metallic_roughness_texture, METALLIC_ROUGHNESS_UV);
    s.metallic *= packed_maps.b;
    s.roughness *= packed_maps.g;
#endif
#if HAS_OCCLUSION_UV
#if OCCLUSION_SHARES_METALLIC_ROUGHNESS
    float occlusion = packed_maps.r;
#else
    float occlusion = texture(occlusion_texture, OCCLUSION_UV).r;
#endif
    s.occlusion = 1.0 + material.factors.w * (occlusion - 1.0);
#endif
#if HAS_EMISSIVE_UV
    s.emissive *= texture(emissive_texture, EMISSIVE_UV).rgb;
#endif
#if HAS_SPECULAR
    s.specular = sample_specular();
#endif
#if HAS_UNLIT
    s.roughness = max(s.roughness, 1.0 / 255.0);  // 0 says unlit
#endif
#if UNLIT
    // KHR_materials_unlit: the base colour is what leaves the surface, whatever the lights.
    s.emissive = s.base_color.rgb;
    s.base_color.rgb = vec3(0.0);
    s.metallic = 0.0;
    s.roughness = 1.0 - float(HAS_UNLIT);
#endif
#if ALPHA_MASK
    if (s.base_color.a < material.emissive_cutoff.w) discard;
#endif
    return s;
}
#endif
