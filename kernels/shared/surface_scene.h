// SPDX-License-Identifier: Apache-2.0
// The scene's surfaces for kernels and shaders: meshes, instances, materials and textures in plain
// buffers.
#ifndef KILOLUX_SHARED_SURFACE_SCENE_H
#define KILOLUX_SHARED_SURFACE_SCENE_H
#include "kernels/shared/material.h"
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// Marks a missing attribute or texture.
#define SURFACE_ABSENT 0xffffffffu

// A mesh: vertices as rows of floats in one buffer, triangles as vertex numbers in another. Normals
// and tangents have length 1, or 0 where the mesh gives no direction.
SHARED_STRUCT(MeshRow) {
    uint first_float;    // of vertex 0
    uint vertex_floats;  // of a row
    uint first_index;    // of triangle 0, of three
    uint material;       // row
    uint normal;         // each attribute's place in a vertex's row [float]; the position is at 0
    uint tangent;
    uint texcoord0;
    uint texcoord1;
    uint color;
    uint unused0, unused1, unused2;
};
SHARED_ASSERT(mesh_row_size, sizeof(MeshRow) == 48);

// A drawn instance. p_view = linear * ((p - eye_high) - eye_low) + offset: the camera is subtracted
// in object space, where that loses no digits near the camera. Where the transform has no inverse
// the eye is 0 and the offset the whole translation.
SHARED_STRUCT(InstanceRow) {
    float4 view_from_object[3];    // xyz: a row of the linear part; w: of the offset [m]
    float4 normal_from_object[3];  // xyz: a row, up to a positive scale; [0].w: HANDEDNESS
    float4 eye_high;               // xyz: the camera in object space, rounded
    float4 eye_low;                // xyz: what rounding lost
    uint first_triangle;           // the id of the mesh's triangle 0 is this + 1
    uint mesh;
    uint is_similarity;  // 1: normal_from_object is a rotation, and turns tangents, too
    uint first_caster;   // the mesh's triangle 0 along the scene's instances
};
SHARED_ASSERT(instance_row_size, sizeof(InstanceRow) == 144);
// Of an instance's row: 1, or -1 if it mirrors its mesh.
#define HANDEDNESS(row) ((row).normal_from_object[0].w)

// A table holds the instance of every INSTANCE_BLOCK-th triangle, and of the last one, so that the
// search for a triangle's instance covers few.
#define INSTANCE_BLOCK 64

// Bits of SurfaceMaterial::flags, beside those of uses.
#define USES_MAX 16
SHARED_ASSERT(uses_have_bits, USE_COUNT <= USES_MAX);
#define MATERIAL_DOUBLE_SIDED (1u << 16)
#define MATERIAL_UNLIT (1u << 17)
#define MATERIAL_MASKED (1u << 18)   // cut by its alpha
#define MATERIAL_BLENDED (1u << 19)  // alphaMode BLEND

SHARED_STRUCT(SurfaceMaterial) {
    MaterialRow row;
    uint textures[USES_MAX];  // TextureRows by use
    uint flags;               // bit USE_*: the use reads texcoord1; and see above
    uint lookup_use;          // the use whose lookup others share; SURFACE_ABSENT: none
    uint lookup_shared;       // bit USE_*: the use reads the texels of that lookup
    uint unused0;
};
SHARED_ASSERT(surface_material_size, sizeof(SurfaceMaterial) == sizeof(MaterialRow) + 80);

#define WRAP_REPEAT 0u
#define WRAP_CLAMP 1u
#define WRAP_MIRROR 2u

// Bits of TextureRow::filters.
#define FILTER_MAGNIFY_NEAREST 1u
#define FILTER_MINIFY_NEAREST 2u
#define FILTER_NO_MIPMAPS 4u
#define FILTER_NEAREST_MIPMAP 8u

// An image is at most 2^(TEXTURE_LEVELS - 1) texels a side.
#define TEXTURE_LEVELS 16

SHARED_STRUCT(TextureRow) {
    uint width, height;  // of level 0 [texel]
    uint levels;
    uint filters;  // FILTER_*
    uint wrap_s, wrap_t;
    uint first_texel;  // of level 0
    uint unused0;
    uint level_offset[TEXTURE_LEVELS];  // of each level's first texel from level 0's
};
SHARED_ASSERT(texture_row_size, sizeof(TextureRow) == 96);

#if !defined(__cplusplus)
// Texels of 64 bits in lanes, as their low and high halves.
SHARED_PLAIN_STRUCT(Texels) { UV low, high; };
#endif

// A triangle as raster_triangles draws it: affine functions of a pixel's ray, one cache line.
SHARED_STRUCT(RasterRow) {
    float edge[9];   // three times x, y, z: scaled and positive inside, see raster_triangle.h
    float plane[3];  // key = plane[0] ray.x + plane[1] ray.y - plane[2]
    float farthest;  // of the vertices' keys
    float nearest;   // infinite behind the eye
    uint columns;    // pixels of the planes that it may cover: first | last << 16
    uint rows;
};
SHARED_ASSERT(raster_row_size, sizeof(RasterRow) == 64);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
