// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>

#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"

/// Everything that passes between stages. Buffers belong to the stage that made them and stay valid
/// until its next enqueue().
namespace kilolux {

/// A G-buffer on the device: planes of view.stride * view.height elements in one buffer.
struct GBuffer {
    cl::Buffer bytes;
    GBufferLayout layout{};
    View view{};
};

/// Lights as the host hands them over.
struct LightInput {
    cl::Buffer lights;  // Light[count], camera-relative
    uint count = 0;
    cl::Buffer directional;  // DirectionalLight[directional_count], world axes
    uint directional_count = 0;
};

/// Lights ready for culling and shading.
struct PreparedLights {
    cl::Buffer lights;   // ShadeLight[count], view space
    cl::Buffer bounds;   // float4[count]: p_view, 1/range^2
    cl::Buffer extents;  // LightExtent[count]
    uint count = 0;
    cl::Buffer directional;  // DirectionalLight[directional_count], view space
    uint directional_count = 0;
};

/// Boxes of the coarse clusters: products of intervals, float2 each [m].
struct ClusterBoxes {
    ClusterGrid grid{};
    cl::Buffer columns;  // [slices][tiles_x]
    cl::Buffer rows;     // [slices][tiles_y]
    cl::Buffer depths;   // [slices]
};

/// Ascending light indices of each coarse cluster: lists[offsets[c] .. offsets[c + 1]).
struct CoarseLists {
    cl::Buffer offsets;  // uint[cluster_count + 1]
    cl::Buffer lists;    // uint16 or uint32 [capacity]
    uint capacity = 0;
};

/// Active clusters of each fine tile: clusters[offsets[tile] .. offsets[tile + 1]).
struct ActiveClusters {
    cl::Buffer offsets;   // uint[tile_count + 1]
    cl::Buffer clusters;  // ActiveCluster[capacity]
    uint capacity = 0;
    uint tile_count = 0;
    // uchar[tile_count][FINE_TILE_PIXELS]: row * FINE_TILE + column of a tile's pixels, cluster by
    // cluster and then those of none; of no meaning in tiles without clusters.
    cl::Buffer order;
    cl::Buffer occupied;  // uchar[cluster_count]: 1 for coarse clusters with active ones
};

/// Lists of the active clusters, where ActiveCluster::list_begin and list_count say.
struct RefinedLists {
    cl::Buffer lists;  // uint16 or uint32 [capacity]
    uint capacity = 0;
};

/// Linear HDR radiance as three planes.
struct Radiance {
    cl::Buffer planes;  // float[3][height][stride]
    View view{};
};

}  // namespace kilolux
