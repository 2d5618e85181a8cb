// SPDX-License-Identifier: Apache-2.0
// The surfaces of triangle ids: the scene's buffers in OpenCL C, and triangles set up one by one
// (kernels/shared/triangle.h).
#ifndef KILOLUX_DEVICE_TRIANGLE_H
#define KILOLUX_DEVICE_TRIANGLE_H
#include "kernels/device/lanes.h"
#include "kernels/device/pixels.h"
#include "kernels/device/texture.h"
#include "kernels/shared/surface_scene.h"
#include "kernels/shared/view.h"

// The scene's buffers.
typedef struct SurfaceScene {
    global const InstanceRow* instances;  // ascending first_triangle, and an end
    global const uint* instance_blocks;   // the instance of every INSTANCE_BLOCK-th triangle
    global const MeshRow* meshes;
    global const float* vertices;
    global const uint* indices;
    global const SurfaceMaterial* materials;
    global const TextureRow* textures;
    global const ulong* texels;
} SurfaceScene;

typedef global const InstanceRow* InstanceRef;
typedef global const SurfaceMaterial* MaterialRef;
typedef global const float* VertexRef;

#define INSTANCE(instance) (*(instance))
#define MATERIAL(material) (*(material))
#define MESH(scene, i) (scene).meshes[i]
#define vertex_index(scene, i) (scene).indices[i]
#define vertex_float(vertex, place) (vertex)[place]
#define vertex_float2(vertex, place) vload2(0, (vertex) + (place))
#define vertex_float3(vertex, place) vload3(0, (vertex) + (place))
#define vertex_float4(vertex, place) vload4(0, (vertex) + (place))

static inline VertexRef vertex_row(SurfaceScene scene, MeshRow mesh, uint index) {
    return scene.vertices + mesh.first_float + (size_t)index * mesh.vertex_floats;
}

static inline TextureBuffers textures_of_scene(SurfaceScene scene) {
    TextureBuffers buffers = {scene.textures, scene.texels};
    return buffers;
}

#include "kernels/shared/triangle.h"

static inline uint instance_of(SurfaceScene scene, uint triangle) {
    global const uint* block = scene.instance_blocks + triangle / INSTANCE_BLOCK;
    uint first = block[0];
    uint end = block[1] + 1u;
    while (end - first > 1u) {
        uint middle = (first + end) / 2u;
        if (scene.instances[middle].first_triangle <= triangle) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

static inline Triangle fetch_triangle(SurfaceScene scene, uint id) {
    InstanceRef instance = scene.instances + instance_of(scene, id - 1u);
    return mesh_triangle(scene, instance, id - 1u - instance->first_triangle);
}

// The number in the first lane of `mask`.
static inline uint first_of(UV numbers, MASK mask) {
#if VW == 1
    return numbers;
#else
    return lane_min_uint(select((UV)(SURFACE_ABSENT), numbers, mask));
#endif
}

// The attributes where `shown`; undefined elsewhere.
static inline Fragment interpolate_fragment(SurfaceScene scene, View view, Pixels pixels, UV ids,
                                            MASK shown) {
    Fragment fragment = no_fragment();
    for (MASK left = shown; lane_any(left);) {
        uint id = first_of(ids, left);
        MASK mask = lane_mask(ids == (UV)(id)) & shown;
        interpolate_triangle(view, pixels, fetch_triangle(scene, id), mask, &fragment);
        left &= ~mask;
    }
    return fragment;
}
#endif
