// SPDX-License-Identifier: Apache-2.0
// G-buffer layouts: their planes, the content of planes, the values of a surface, and the packing
// of normals.
#ifndef KILOLUX_SHARED_GBUFFER_H
#define KILOLUX_SHARED_GBUFFER_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// Layouts, by name on the command line.
// packed: depth f32 | normal 2x16 | albedo sRGB8 + roughness 8 (+ material, occlusion, specular)
#define GBUFFER_PACKED 0
// full: float32 position, normal, linear albedo, ...: for error accounting
#define GBUFFER_FULL 1
// half: float16 position and normal, 8-bit linear albedo (three WebGPU ancestors)
#define GBUFFER_HALF 2
// normal-xy: packed, but normal.xy only with z = +sqrt(1-x^2-y^2) (one WebGL ancestor)
#define GBUFFER_NORMAL_XY 3
// oct-2x4: two float4: position + packed albedo, octahedral normal + ... (one WebGL ancestor)
#define GBUFFER_OCT_2X4 4

// Planes. Each is stride * height elements; a G-buffer is one buffer that holds its planes one
// after the other. A layout has some of them; the scene plan leaves out what the scene does not
// need ("optional").
// all: float reversed-Z depth01, or BACKGROUND_DEPTH
#define PLANE_DEPTH 0
#define BACKGROUND_DEPTH 0.0f
// packed: uint, 2x16 UNORM octahedral view-space normal, x in the low half; normal-xy: its x and y
#define PLANE_NORMAL 1
// packed: uchar4, sRGB-encoded base colour, roughness linear in the 4th; half: colour linear too
#define PLANE_ALBEDO 2
// The roughness that marks unlit surfaces; lit ones have at least LIT_ROUGHNESS_MIN, whose lobe has
// the same width.
#define UNLIT_ROUGHNESS 0.0f
#define LIT_ROUGHNESS_MIN (1.0f / 255.0f)
// In place of a roughness: repack_gbuffer takes the albedo's 4th channel.
#define ROUGHNESS_OF_ALBEDO (-1.0f)
// packed, optional: uchar4, sRGB-encoded emissive / emissive_scale, metallic in the 4th
#define PLANE_MATERIAL 3
// packed, optional: uchar, ambient occlusion, linear
#define PLANE_OCCLUSION 4
// full: float [m] view space; half: half [m] world space
#define PLANE_POSITION_X 5
#define PLANE_POSITION_Y 6
#define PLANE_POSITION_Z 7
// full: float, view space, unit; half: half, world space
#define PLANE_NORMAL_X 8
#define PLANE_NORMAL_Y 9
#define PLANE_NORMAL_Z 10
// full: float, linear Rec. 709
#define PLANE_ALBEDO_R 11
#define PLANE_ALBEDO_G 12
#define PLANE_ALBEDO_B 13
// full: float, perceptual
#define PLANE_ROUGHNESS 14
// full, optional: float
#define PLANE_METALLIC 15
// full, optional: float, linear radiance
#define PLANE_EMISSIVE_R 16
#define PLANE_EMISSIVE_G 17
#define PLANE_EMISSIVE_B 18
// full, optional: float
#define PLANE_OCCLUSION_F 19
// oct-2x4: float4, view-space position [m]; linear albedo: 8 bits a channel, red lowest, as the
// float's value
#define PLANE_ROW_0 20
// oct-2x4: float4, octahedral view-space normal in [-1, 1]^2, roughness, metallic
#define PLANE_ROW_1 21
// all but full, optional: uchar4, square roots of the dielectric's reflectance head on; grazing in
// the 4th
#define PLANE_SPECULAR 22
// full, optional: float, the reflectance head on
#define PLANE_SPECULAR_R 23
#define PLANE_SPECULAR_G 24
#define PLANE_SPECULAR_B 25
// full, optional: float, the reflectance at grazing angles
#define PLANE_SPECULAR_F90 26
// all but full, optional: uint, the clear coat's factor in 16 bits, its roughness in the high 16
#define PLANE_COAT 27
// all but full, optional: uint, the coat's normal as in PLANE_NORMAL of packed
#define PLANE_COAT_NORMAL 28
// full, optional: float, the coat's factor
#define PLANE_COAT_F 29
// full, optional: float, the coat's perceptual roughness
#define PLANE_COAT_ROUGHNESS 30
// full, optional: float, the coat's normal, view space, unit
#define PLANE_COAT_NORMAL_X 31
#define PLANE_COAT_NORMAL_Y 32
#define PLANE_COAT_NORMAL_Z 33
// all but full, optional: uchar4, square roots of the sheen's linear colour, its roughness in the
// 4th
#define PLANE_SHEEN 34
// full, optional: float, the sheen's colour, linear Rec. 709
#define PLANE_SHEEN_R 35
#define PLANE_SHEEN_G 36
#define PLANE_SHEEN_B 37
// full, optional: float, the sheen's perceptual roughness
#define PLANE_SHEEN_ROUGHNESS 38
// all but full, optional: uint, the line along which highlights stretch (pack_anisotropy()) in 16
// bits, their strength in the high 16
#define PLANE_ANISOTROPY 39
// full, optional: float, that direction, view space, unit, perpendicular to the normal
#define PLANE_TANGENT_X 40
#define PLANE_TANGENT_Y 41
#define PLANE_TANGENT_Z 42
// full, optional: float, the strength
#define PLANE_ANISOTROPY_F 43
// all but full, of layers, with tinted shadows of all: uchar4, square roots of the tint, the
// transmission in the 4th
#define PLANE_TRANSMISSION 44
// full, of layers, with tinted shadows of all: float, the tint, linear Rec. 709
#define PLANE_TINT_R 45
#define PLANE_TINT_G 46
#define PLANE_TINT_B 47
// full, of layers, with tinted shadows of all: float
#define PLANE_TRANSMISSION_F 48
#define PLANE_COUNT 49
#define PLANE_ABSENT 0xffffffffu

// The values of a surface beside its position and normal, a row each.
//   has      1 if the scene's G-buffers hold the value
//   member   of Surface and of the references' SurfaceSample
//   decoded  its first plane of a decoded G-buffer
//   plane    its first plane of the layout `full`
//   value    the default, where `has` is 0
#define SURFACE_VALUES(VECTOR, SCALAR)                                                            \
    VECTOR(1, albedo, SURFACE_ALBEDO, PLANE_ALBEDO_R, 0.0f)        /* linear Rec. 709 */          \
    SCALAR(1, roughness, SURFACE_ROUGHNESS, PLANE_ROUGHNESS, 1.0f) /* perceptual */               \
    SCALAR(HAS_MATERIAL, metallic, SURFACE_METALLIC, PLANE_METALLIC, 0.0f)                        \
    VECTOR(HAS_MATERIAL, emissive, SURFACE_EMISSIVE, PLANE_EMISSIVE_R, 0.0f) /* radiance */       \
    SCALAR(HAS_OCCLUSION, occlusion, SURFACE_OCCLUSION, PLANE_OCCLUSION_F, 1.0f)                  \
    /* reflectance of the dielectric part head on, and at grazing angles */                       \
    VECTOR(HAS_SPECULAR, specular, SURFACE_SPECULAR, PLANE_SPECULAR_R, DIELECTRIC_F0)             \
    SCALAR(HAS_SPECULAR, specular_f90, SURFACE_SPECULAR_F90, PLANE_SPECULAR_F90, 1.0f)            \
    /* KHR_materials_clearcoat */                                                                 \
    SCALAR(HAS_CLEARCOAT, coat, SURFACE_COAT, PLANE_COAT_F, 0.0f)                                 \
    SCALAR(HAS_CLEARCOAT, coat_roughness, SURFACE_COAT_ROUGHNESS, PLANE_COAT_ROUGHNESS, 1.0f)     \
    VECTOR(HAS_COAT_NORMAL, coat_normal, SURFACE_COAT_NORMAL, PLANE_COAT_NORMAL_X, 0.0f)          \
    /* KHR_materials_sheen */                                                                     \
    VECTOR(HAS_SHEEN, sheen, SURFACE_SHEEN, PLANE_SHEEN_R, 0.0f)                                  \
    SCALAR(HAS_SHEEN, sheen_roughness, SURFACE_SHEEN_ROUGHNESS, PLANE_SHEEN_ROUGHNESS, 1.0f)      \
    /* KHR_materials_volume's transmittance of what lies below, and KHR_materials_transmission */ \
    VECTOR(HAS_TRANSMISSION, tint, SURFACE_TINT, PLANE_TINT_R, 1.0f)                              \
    SCALAR(HAS_TRANSMISSION, transmission, SURFACE_TRANSMISSION, PLANE_TRANSMISSION_F, 0.0f)      \
    /* KHR_materials_anisotropy */                                                                \
    VECTOR(HAS_ANISOTROPY, tangent, SURFACE_TANGENT, PLANE_TANGENT_X, 0.0f)                       \
    SCALAR(HAS_ANISOTROPY, anisotropy, SURFACE_ANISOTROPY, PLANE_ANISOTROPY_F, 0.0f)
// Reflectance of dielectrics at normal incidence (glTF 2.0, appendix B).
#define DIELECTRIC_F0 0.04f

// GLSL has no enums and writes attachments; `layout` is a word of its own there.
#if !defined(GL_core_profile)
// Float planes of a decoded G-buffer.
#define THREE_PLANES(has, member, decoded, plane, value) decoded, decoded##_Y, decoded##_Z,
#define ONE_PLANE(has, member, decoded, plane, value) decoded,
enum SurfacePlane {
    SURFACE_DEPTH,                                   // z [m], > 0 in front; 0 for background
    THREE_PLANES(1, position, SURFACE_POSITION, , )  // view space [m]
    THREE_PLANES(1, normal, SURFACE_NORMAL, , )      // view space, unit
    SURFACE_VALUES(THREE_PLANES, ONE_PLANE) SURFACE_PLANES
};

SHARED_STRUCT(GBufferLayout) {
    uint offset_bytes[PLANE_COUNT];  // of each plane in the buffer, a multiple of 256; PLANE_ABSENT
                                     // if not there
    uint layout;                     // GBUFFER_*
    float emissive_scale;  // largest emissive value of the scene, > 0: PLANE_MATERIAL is relative
                           // to it
    uint bytes_per_pixel;
};
SHARED_ASSERT(gbuffer_layout_size, sizeof(GBufferLayout) == 208);
#endif

// Octahedral coordinates in [-1, 1]^2 of a unit vector. Cigolle et al. 2014, "A Survey of Efficient
// Representations for Independent Unit Vectors", listing 1. A zero vector maps to (0, 0), that is
// +z.
SHARED_FN FV3 octahedral_encode(FV3 n) {
    FV ax = max(n.x, -n.x);
    FV ay = max(n.y, -n.y);
    FV az = max(n.z, -n.z);
    FV sum = ax + ay + az;
    FV inv = lane_select(sum > fv(0.0f), fv(1.0f) / sum, fv(0.0f));
    FV x = n.x * inv;
    FV y = n.y * inv;
    FV one = fv(1.0f);
    FV sign_x = lane_select(x >= fv(0.0f), one, -one);
    FV sign_y = lane_select(y >= fv(0.0f), one, -one);
    MASK lower = n.z < fv(0.0f);
    FV fx = (one - ay * inv) * sign_x;
    FV fy = (one - ax * inv) * sign_y;
    return fv3(lane_select(lower, fx, x), lane_select(lower, fy, y), fv(0.0f));
}

// Unit vector of octahedral coordinates in [-1, 1]^2 (ibid.).
SHARED_FN FV3 octahedral_decode(FV x, FV y) {
    FV ax = max(x, -x);
    FV ay = max(y, -y);
    FV zero = fv(0.0f);
    FV z = fv(1.0f) - ax - ay;
    FV fold = max(-z, zero);
    FV nx = x + lane_select(x >= zero, -fold, fold);
    FV ny = y + lane_select(y >= zero, -fold, fold);
    FV inv = fv(1.0f) / lane_sqrt(fma(nx, nx, fma(ny, ny, z * z)));
    return fv3(nx * inv, ny * inv, z * inv);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
