// SPDX-License-Identifier: Apache-2.0
// What the raster shaders read of a material and of a frame, declared once for C++ and GLSL.
#ifndef KILOLUX_RASTER_DRAW_ROWS_H
#define KILOLUX_RASTER_DRAW_ROWS_H
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/types.h"
#include "kernels/shared/view.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// A material's texture uses: texture units and rows of uv transforms.
#define USE_BASE_COLOR 0
#define USE_METALLIC_ROUGHNESS 1
#define USE_NORMAL 2
#define USE_OCCLUSION 3
#define USE_EMISSIVE 4
#define USE_SPECULAR 5
#define USE_SPECULAR_COLOR 6
#define USE_COUNT 7

// Texture units of what forward shading reads of lights, where it does so from textures.
#define LIGHTS_UNIT 8
#define CLUSTER_OFFSETS_UNIT 9
#define LIGHT_LISTS_UNIT 10

SHARED_STRUCT(MaterialRow) {
    float4 base_color;       // linear Rec. 709, alpha
    float4 emissive_cutoff;  // xyz: linear radiance; w: alpha cutoff
    float4 factors;          // metallic, roughness, normal scale, occlusion strength
    float4 specular;         // xyz: reflectance head on times the colour factor; w: specular factor
    float4 uv_x[USE_COUNT];  // xyz: u = dot(xyz, (texcoord, 1))
    float4 uv_y[USE_COUNT];  // xyz: v likewise
};
SHARED_ASSERT(material_row_size, sizeof(MaterialRow) == 288);

// What forward shading needs beside materials and lights.
SHARED_STRUCT(ForwardRow) {
    View view;
    ClusterGrid grid;  // forward-plus only
    uint light_count;
    uint directional_count;
    float ambient;  // radiance that falls in from everywhere
    uint unused0;
};
SHARED_ASSERT(forward_row_size, sizeof(ForwardRow) == 192);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
