// SPDX-License-Identifier: Apache-2.0
// A frame's data for the raster shaders and its binding points, declared once for C++ and GLSL.
#ifndef KILOLUX_RASTER_DRAW_ROWS_H
#define KILOLUX_RASTER_DRAW_ROWS_H
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/surface_scene.h"
#include "kernels/shared/types.h"
#include "kernels/shared/view.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// Texture units: a material's maps come first, by USE_*; then the lights of forward shading, where
// it reads them from textures.
#define LIGHTS_UNIT (USES_MAX + 0)
#define CLUSTER_OFFSETS_UNIT (USES_MAX + 1)
#define LIGHT_LISTS_UNIT (USES_MAX + 2)
#define LIGHT_PROFILES_UNIT (USES_MAX + 3)
#define PROFILE_TABLES_UNIT (USES_MAX + 4)
#define LIGHT_SHAPES_UNIT (USES_MAX + 5)
#define VERTICES_UNIT (USES_MAX + 6)
#define INDICES_UNIT (USES_MAX + 7)

// Storage blocks of the scene, after the seven of forward lights; the last is the G-buffer pass's.
#define INSTANCES_BLOCK 7
#define MESHES_BLOCK 8
#define MATERIALS_BLOCK 9
#define TEXTURES_BLOCK 10
#define SRGB_BLOCK 11

// Uniform blocks.
#define CAMERA_BLOCK 0
#define FORWARD_BLOCK 1

// The camera of a pass.
SHARED_STRUCT(CameraRow) {
    View view;
    float4 clip_from_view[4];  // columns
};
SHARED_ASSERT(camera_row_size, sizeof(CameraRow) == 192);

// The data of forward shading beside surfaces and lights.
SHARED_STRUCT(ForwardRow) {
    ClusterGrid grid;  // forward-plus only
    uint light_count;
    uint directional_count;
    float ambient;  // radiance that falls in from everywhere
    uint unused0;
};
SHARED_ASSERT(forward_row_size, sizeof(ForwardRow) == 64);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
