// SPDX-License-Identifier: Apache-2.0
// Parameters that kernels take together. The host's struct that stands above each macro sets them
// in this order; most are in host/gpu/flow.h and surface_flow.h. Pointers to what a scene lacks are
// null. `access`: const, or nothing where the kernel writes.
#ifndef KILOLUX_DEVICE_ARGUMENTS_H
#define KILOLUX_DEVICE_ARGUMENTS_H
#include "kernels/device/light_index.h"
#include "kernels/device/stored_light.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/light_extras.h"
#include "kernels/shared/lights/light_tree.h"
#include "kernels/shared/shadow.h"
#include "kernels/shared/surface_scene.h"
#include "kernels/shared/view.h"

// GBuffer. srgb: [256], linear value of an sRGB code.
#define GBUFFER_ARGS                                                       \
    global const uchar *restrict gbuffer, GBufferLayout layout, View view, \
        global const float *restrict srgb

// PreparedLights, view space. lights, bounds (p_view, 1/range^2), extents, aimed_profiles,
// shapes: [light_count + node_count]; the nodes of the light tree come last. light_groups: the
// same, then [directional_count].
#define LIGHT_ARGS(access)                                                                     \
    global access StoredLight *restrict lights, global access float4 *restrict bounds,         \
        global access LightExtent *restrict extents, uint light_count,                         \
        global const DirectionalLight *restrict directional_lights, uint directional_count,    \
        global const AimedProfile *restrict aimed_profiles,                                    \
        global const float *restrict profile_tables, global const LightShape *restrict shapes, \
        global const uchar *restrict light_groups, global const TreeNode *restrict tree_nodes, \
        uint node_count
#define EXTRAS_OF_ARGS ((LightExtras){{aimed_profiles, profile_tables}, shapes, light_groups})

// ClusterBoxes. columns: [slices][tiles_x]; rows: [slices][tiles_y]; depths: [slices].
#define BOX_ARGS(access)                                                                           \
    ClusterGrid grid, global access float2 *restrict columns, global access float2 *restrict rows, \
        global access float2 *restrict depths

// CoarseLists. coarse_offsets: [cluster_count + 1]; coarse_lists: [coarse_capacity].
#define COARSE_LIST_ARGS(access)                                                                  \
    global const uint *restrict coarse_offsets, global access LIGHT_INDEX *restrict coarse_lists, \
        uint coarse_capacity

// ActiveClusters. cluster_offsets: [tiles + 1]; clusters: [cluster_capacity]; order:
// [tiles][FINE_TILE_PIXELS].
#define CLUSTER_ARGS(access)                                                   \
    ClusterGrid grid, global const uint *restrict cluster_offsets,             \
        global access ActiveCluster *restrict clusters, uint cluster_capacity, \
        global access uchar *restrict order

// RefinedLists. lists: [list_capacity].
#define LIST_ARGS(access) global access LIGHT_INDEX *restrict lists, uint list_capacity

// LitPixels.
#define LIT_ARGS GBUFFER_ARGS, LIGHT_ARGS(const), CLUSTER_ARGS(const), LIST_ARGS(const)

// SurfaceBuffers. instances: sorted by first_triangle, with an end row; instance_blocks: one for
// each INSTANCE_BLOCK triangles.
#define SCENE_ARGS                                                                             \
    global const InstanceRow *restrict instances, global const uint *restrict instance_blocks, \
        global const MeshRow *restrict meshes, global const float *restrict vertices,          \
        global const uint *restrict indices, global const SurfaceMaterial *restrict materials, \
        global const TextureRow *restrict textures, global const ulong *restrict texels
#define SCENE_OF_ARGS                                                                           \
    ((SurfaceScene){instances, instance_blocks, meshes, vertices, indices, materials, textures, \
                    texels})

// ShadowCasters. casters: [][3][3], shadow space.
#define CASTER_ARGS                                                                       \
    global const ShadowNode *restrict shadow_nodes, global const float *restrict casters, \
        global const MaskedCaster *restrict masked_casters,                               \
        global const TintCaster *restrict tint_casters,                                   \
        global const SurfaceMaterial *restrict materials,                                 \
        global const TextureRow *restrict textures, global const ulong *restrict texels

// ShadowInput. origins: [ORIGIN_PLANES][height][stride].
#define SHADOW_ARGS ShadowView shadow, global const float *restrict origins, CASTER_ARGS

// ShadowWords. word_offsets: [tiles + 1]; words: [word_capacity], see cast_shadows.h.
#define WORD_ARGS(access) \
    global const uint *restrict word_offsets, uint word_capacity, global access uint *restrict words

// ShadowTargets. kept: a bit for each word, set for the first word of a light in a cluster if its
// words are there already; null: none are.
#define TARGET_ARGS WORD_ARGS(), global const uint* restrict kept

// ShadowsBefore. clusters_before: in the order of `clusters`.
#define BEFORE_ARGS                                                                                \
    global const float4 *restrict bounds_before, uint count_before,                                \
        global const DirectionalLight *restrict directional_before, uint directional_count_before, \
        global const ActiveCluster *restrict clusters_before,                                      \
        global const LIGHT_INDEX *restrict lists_before,                                           \
        global const uint *restrict word_offsets_before, global const uint *restrict words_before

// ShadowSamples. whole: RADIANCE_PLANES, the radiance if all lights are seen.
#define SAMPLE_ARGS global const float *restrict whole, float rays, uint seed

// SrgbBucketTables: [SRGB_BUCKETS] each.
#define BUCKET_ARGS \
    global const float* restrict bucket_boundary, global const uint* restrict bucket_code

// DisplayTarget. gain: 2^exposure; display: out [height][stride], see display.h.
#define DISPLAY_ARGS float gain, BUCKET_ARGS, global uint *restrict display

// ShadingOutput of host/stages/shading/shade.cpp. radiance: out RADIANCE_PLANES; variance: out
// [height][stride], the estimated variance of the luminance.
#define OUTPUT_ARGS \
    float ambient, global float *restrict radiance, global float *restrict variance, DISPLAY_ARGS

// TriangleLists. triangles: indexed by number, listed ones; offsets: [tiles + 1]; lists:
// [capacity].
#define TRIANGLE_LIST_ARGS(access)                                                   \
    global const RasterRow *restrict triangles, global const uint *restrict offsets, \
        global access uint *restrict lists, uint capacity

#endif
