// SPDX-License-Identifier: Apache-2.0
// A glTF material as shaders and kernels read it.
#ifndef KILOLUX_SHARED_MATERIAL_H
#define KILOLUX_SHARED_MATERIAL_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// A material's texture uses: texture units in GLSL, and rows of uv transforms.
#define USE_BASE_COLOR 0
#define USE_METALLIC_ROUGHNESS 1
#define USE_NORMAL 2
#define USE_OCCLUSION 3
#define USE_EMISSIVE 4
#define USE_SPECULAR 5
#define USE_SPECULAR_COLOR 6
#define USE_CLEARCOAT 7
#define USE_CLEARCOAT_ROUGHNESS 8
#define USE_CLEARCOAT_NORMAL 9
#define USE_SHEEN_COLOR 10
#define USE_SHEEN_ROUGHNESS 11
#define USE_ANISOTROPY 12
#define USE_TRANSMISSION 13
#define USE_THICKNESS 14
#define USE_COUNT 15
// Bits 1 << USE_* of the maps in tangent space.
#define TANGENT_USES ((1u << USE_NORMAL) | (1u << USE_CLEARCOAT_NORMAL) | (1u << USE_ANISOTROPY))

SHARED_STRUCT(MaterialRow) {
    float4 base_color;       // linear Rec. 709, alpha
    float4 emissive_cutoff;  // xyz: linear radiance; w: alpha cutoff
    float4 factors;          // metallic, roughness, normal scale, occlusion strength
    float4 specular;         // xyz: reflectance head on times the colour factor; w: specular factor
    float4 clearcoat;        // factor, roughness, normal scale
    float4 sheen;            // xyz: linear Rec. 709; w: roughness
    float4 anisotropy;       // strength, cosine and sine of the rotation
    float4 volume;           // xyz: log2 of the transmittance of 1 m; w: thickness [object space]
    float4 transmission;     // factor
    float4 uv_x[USE_COUNT];  // xyz: u = dot(xyz, (texcoord, 1))
    float4 uv_y[USE_COUNT];  // xyz: v likewise
};
SHARED_ASSERT(material_row_size, sizeof(MaterialRow) == 144 + 32 * USE_COUNT);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
