// SPDX-License-Identifier: Apache-2.0
// What the raster shaders read of a material and of a frame, declared once for C++ and GLSL.
#ifndef KILOLUX_RASTER_DRAW_ROWS_H
#define KILOLUX_RASTER_DRAW_ROWS_H
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/material.h"
#include "kernels/shared/types.h"
#include "kernels/shared/view.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// Texture units of what forward shading reads of lights, where it does so from textures.
#define LIGHTS_UNIT 8
#define CLUSTER_OFFSETS_UNIT 9
#define LIGHT_LISTS_UNIT 10
#define LIGHT_PROFILES_UNIT 11
#define PROFILE_TABLES_UNIT 12

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
