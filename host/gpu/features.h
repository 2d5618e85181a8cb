// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/base/scene_features.h"
#include "host/gpu/program.h"
#include "kernels/shared/gbuffer.h"

namespace kilolux {

/// Features that are compiled into the kernels: the scene plan's device half. Those that the scene
/// lacks are left out.
struct KernelFeatures : SceneFeatures {
    int shading = 0;  // SHADING_*
    uint gbuffer = GBUFFER_PACKED;
    int light_index_bits = 16;  // 16 while every light's index fits
    // Approximations, off unless asked for: how shading computes, and stores lights' colours.
    bool fast_relaxed_math = false;  // -cl-fast-relaxed-math
    bool native_math = false;        // native_sqrt, native_rsqrt, native_recip
    bool half_light_colors = false;
    bool sampled_shadows = false;  // with `shadows`: of picked lights only
    bool tinted_shadows = false;   // with `shadows`, not sampled: surfaces that blend cast some
    bool light_tree = false;       // Tails::tree, and the scene has lights for the tree
    float tree_share = 0.0f;       // with light_tree: error of a node, see tree_cut.h
    bool operator==(const KernelFeatures&) const = default;
};

/// LIGHT_INDEX of the kernels, and its size [byte].
std::string_view light_index_type(const KernelFeatures& features);
std::size_t light_index_bytes(const KernelFeatures& features);

BuildOptions feature_options(const KernelFeatures& features);

/// Work sizes by device class. Data, found by measuring (`kilolux bench --tune`). Results do not
/// depend on them; with other pbr_lanes a GPU may round divisions and roots differently. A
/// certificate that is older than a parameter ships the value below.
struct Tuning {
    int shade_rows = 1;      // rows of a shading work-group at the device's lane width: 1..16
    int shade_stage = 0;     // lights that a shading work-group stages in local memory; 0: none
    int pbr_lanes = 0;       // of PBR shading but with sampled shadows; 0: the device's lanes
    int shade_prefetch = 0;  // 1: shading asks for the next tile's pixels ahead, and
                             // resolve_surfaces for texels; 0: they do not
    int cull_group = 1;      // work-items that share a cluster's lights; 1: none do
    int cull_chunks = 8;     // contiguous chunks of lights, of triangles
    int refine_group = 1;    // work-items that share a tile's lists
    int prefix_group = 1;    // work-items of a block of the prefix sum
    int prefix_per_item = 16384;
    int tile_group = 1;    // work-items that share a tile's pixels
    int light_group = 1;   // work-items of prepare_lights, build_clusters and other maps
    int raster_group = 1;  // work-items that share a tile's triangles
    // Size of triangles' tiles: powers of two of at least 16 [pixel]. With raster_group the width
    // is that of large pictures.
    int raster_tile_width = 64;
    int raster_tile_height = 64;
    int geometry = 0;      // what --geometry auto is: 0 OpenGL's ids, 1 OpenCL's
    int shadow_group = 1;  // work-items that share a cluster's shadows: 1, or 32..256; 0: none do
    int raster_lanes = 1;  // of triangles and their pixels; the device's lane width bounds them
    bool operator==(const Tuning&) const = default;
};

/// The tuning with pbr_lanes 0, so that all shading uses the device's lanes: where the user or the
/// renderer sets their number, and for sampled shadows, whose kernels must pick the same lights.
Tuning with_device_lanes(Tuning tuning);

/// Work-items of a group: `wanted`, a power of two, or the largest one below it that the device
/// takes; 1 where that is below `least`.
int fitting_group(int wanted, const DeviceInfo& device, int least = 1);

Tuning default_tuning(const DeviceInfo& device);

}  // namespace kilolux
