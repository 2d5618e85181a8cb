// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "host/gpu/buffer.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/light.h"
#include "kernels/shared/light_profile.h"
#include "kernels/shared/light_tree.h"
#include "kernels/shared/view.h"

/// Everything that passes between stages. Arrays belong to the stage that made them and stay valid
/// until its next enqueue().
namespace kilolux {

/// A G-buffer on the device: planes of view.stride * view.height elements in one buffer.
struct GBuffer {
    DeviceArray<std::byte> bytes;
    GBufferLayout layout{};
    View view{};
    std::uint64_t version = 0;  // the same only where the planes and the view are; 0: not known
};

/// The photometric webs of point and spot lights, with KernelFeatures::light_profiles.
struct ProfileInput {
    std::optional<DeviceArray<AimedProfile>> lights;  // one per light and node
    std::optional<DeviceArray<float>> tables;         // see light_profile.h
};

/// Lights as the host hands them over.
struct LightInput {
    DeviceArray<Light> lights;  // [count + node_count], camera-relative
    uint count = 0;
    DeviceArray<DirectionalLight>
        directional{};  // [directional_count], world axes; none: no buffer
    uint directional_count = 0;
    ProfileInput profiles{};    // world axes
    uint seed = 0;              // of drawn ranges, see light_transform.h; 0: none is drawn
    std::uint64_t version = 0;  // the same only where the lights are; 0: not known
    // With KernelFeatures::light_tree, lights that are in no coarse list: the nodes of a tree.
    uint node_count = 0;
    DeviceArray<TreeNode> nodes{};  // [node_count]
};

/// Lights ready for culling and shading.
struct PreparedLights {
    DeviceArray<ShadeLight> lights;  // [count + node_count], view space
    DeviceArray<float4> bounds;      // the same places: p_view, 1/range^2
    DeviceArray<LightExtent> extents;
    uint count = 0;
    DeviceArray<DirectionalLight> directional;  // [directional_count], view space
    uint directional_count = 0;
    ProfileInput profiles;  // view space
    uint node_count = 0;    // see LightInput
    DeviceArray<TreeNode> nodes{};
    uint rows() const { return count + node_count; }
};

/// The two ends of a box along one axis [m].
struct BoxInterval {
    float lo, hi;
};

/// Boxes of the coarse clusters: products of intervals.
struct ClusterBoxes {
    ClusterGrid grid{};
    DeviceArray<BoxInterval> columns;  // [slices][tiles_x]
    DeviceArray<BoxInterval> rows;     // [slices][tiles_y]
    DeviceArray<BoxInterval> depths;   // [slices]
};

/// Light indices of 16 or 32 bits, as KernelFeatures::light_index_bits says.
using LightIndexBytes = DeviceArray<std::byte>;

/// Ascending light indices of each coarse cluster: lists[offsets[c] .. offsets[c + 1]).
struct CoarseLists {
    DeviceArray<uint> offsets;  // [cluster_count + 1]
    LightIndexBytes lists;      // [capacity] indices
    uint capacity = 0;
};

/// Active clusters of each fine tile: clusters[offsets[tile] .. offsets[tile + 1]).
struct ActiveClusters {
    DeviceArray<uint> offsets;            // [tile_count + 1]
    DeviceArray<ActiveCluster> clusters;  // [capacity]
    uint capacity = 0;
    uint tile_count = 0;
    // [tile_count][FINE_TILE_PIXELS]: row * FINE_TILE + column of a tile's pixels, cluster by
    // cluster and then background; undefined in tiles without clusters.
    DeviceArray<std::uint8_t> order;
    DeviceArray<std::uint8_t> occupied;  // [cluster_count]: 1 for coarse clusters with active ones
};

/// Lists of the active clusters, where ActiveCluster::list_begin and list_count say.
struct RefinedLists {
    LightIndexBytes lists;  // [capacity] indices
    uint capacity = 0;
};

/// Of two halves of the samples, those that a fine tile's mean ends with; 0 while it takes more. A
/// tile where both have ended is done.
struct TileCounts {
    DeviceArray<uint> fixed;  // [2][tile_count]
};

/// What a frame's pixels are lit by.
struct LitPixels {
    GBuffer gbuffer;
    PreparedLights lights;
    ClusterGrid grid{};
    ActiveClusters clusters;
    RefinedLists refined;
};

/// Linear HDR radiance as three planes.
struct Radiance {
    static constexpr std::size_t kPixelBytes = 3 * sizeof(float);
    DeviceArray<float> planes;  // [3][height][stride]; none where it was shaded to a DisplayTarget
    View view{};
};

/// Where a display's sRGB codes go, and how radiance becomes codes.
struct DisplayTarget {
    static constexpr std::size_t kPixelBytes = sizeof(uint);
    DeviceArray<uint> pixels;  // [height][stride]: R | G << 8 | B << 16 | 255 << 24
    View view{};
    int tone_curve = 0;                  // TONE_CURVE_*
    float gain = 1.0f;                   // 2^exposure
    DeviceArray<float> bucket_boundary;  // [SRGB_BUCKETS]
    DeviceArray<uint> bucket_code;       // [SRGB_BUCKETS]
};

}  // namespace kilolux
