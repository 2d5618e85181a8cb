// SPDX-License-Identifier: Apache-2.0
// The scene in GLSL: the rows that the kernels read, and the mips that they filter.
#include "raster/shaders/draw_rows.h"

layout(location = 0) uniform uint drawn_instance;
layout(std140, binding = CAMERA_BLOCK) uniform CameraBlock { CameraRow camera; };
layout(std430, binding = INSTANCES_BLOCK) readonly buffer Instances {
    InstanceRow scene_instances[];
};
layout(std430, binding = MESHES_BLOCK) readonly buffer Meshes { MeshRow scene_meshes[]; };
layout(std430, binding = MATERIALS_BLOCK) readonly buffer Materials {
    SurfaceMaterial scene_materials[];
};
layout(std430, binding = TEXTURES_BLOCK) readonly buffer TextureRows {
    TextureRow scene_textures[];
};
layout(binding = 0) uniform usamplerBuffer scene_maps[USE_COUNT];  // of the drawn material
layout(binding = VERTICES_UNIT) uniform samplerBuffer scene_vertices;
layout(binding = INDICES_UNIT) uniform usamplerBuffer scene_indices;
