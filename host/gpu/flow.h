// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "host/gpu/buffer.h"
#include "host/gpu/device_tables.h"
#include "host/gpu/kernel_types.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/light.h"
#include "kernels/shared/light_extras.h"
#include "kernels/shared/lights/light_tree.h"
#include "kernels/shared/view.h"

/// Everything that passes between stages. Arrays belong to the stage that made them and stay valid
/// until its next enqueue(). each() passes a bundle to a kernel, see Kernel: its order and names
/// are those of a macro of kernels/device/arguments.h.
namespace kilolux {

/// A G-buffer on the device: planes of view.stride * view.height elements in one buffer.
struct GBuffer {
    DeviceArray<std::byte> bytes;
    GBufferLayout layout{};
    View view{};
    std::uint64_t version = 0;  // equal only for equal planes and view; 0: unknown

    void each(auto&& set) const {  // GBUFFER_ARGS
        set("gbuffer", bytes);
        set("layout", layout);
        set("view", view);
        set("srgb", SrgbTable{});
    }
};

/// Rows beside lights' own, one per light and node, where the scene has them.
struct LightExtraInput {
    // With KernelFeatures::light_profiles.
    std::optional<DeviceArray<AimedProfile>> profiles;
    std::optional<DeviceArray<float>> profile_tables;  // see light_profile.h
    // With KernelFeatures::area_lights.
    std::optional<DeviceArray<LightShape>> shapes;
    // With KernelFeatures::light_groups: numbers from 1; 0: in none. Directional lights come last.
    std::optional<DeviceArray<std::uint8_t>> groups;
};

/// Lights as the host hands them over.
struct LightInput {
    DeviceArray<Light> lights;  // [count + node_count], camera-relative
    uint count = 0;
    DeviceArray<DirectionalLight>
        directional{};  // [directional_count], world axes; none: no buffer
    uint directional_count = 0;
    LightExtraInput extras{};  // world axes
    uint seed = 0;             // of random ranges, see light_transform.h; 0: no range is random
    // [count]: the index that each light had in the frame before; none: the same. Where one is
    // wrong, its shadows are cast again.
    DeviceArray<uint> index_before{};
    bool have_all_moved = false;  // since the frame before: no shadow can be kept
    std::uint64_t version = 0;    // equal only for equal lights; 0: unknown
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
    LightExtraInput extras;  // view space
    uint node_count = 0;     // see LightInput
    DeviceArray<TreeNode> nodes{};
    DeviceArray<uint> index_before{};  // see LightInput
    uint rows() const { return count + node_count; }

    void each(auto&& set) const {  // LIGHT_ARGS
        set("lights", lights);
        set("bounds", bounds);
        set("extents", extents);
        set("light_count", count);
        set("directional_lights", directional);
        set("directional_count", directional_count);
        set("aimed_profiles", extras.profiles);
        set("profile_tables", extras.profile_tables);
        set("shapes", extras.shapes);
        set("light_groups", extras.groups);
        set("tree_nodes", nodes);
        set("node_count", node_count);
    }
};

/// The two ends of a box along one axis [m].
struct BoxInterval {
    float lo, hi;
};
template <>
inline constexpr std::string_view kKernelType<BoxInterval> = "float2";

/// Boxes of the coarse clusters: products of intervals.
struct ClusterBoxes {
    ClusterGrid grid{};
    DeviceArray<BoxInterval> columns;  // [slices][tiles_x]
    DeviceArray<BoxInterval> rows;     // [slices][tiles_y]
    DeviceArray<BoxInterval> depths;   // [slices]

    void each(auto&& set) const {  // BOX_ARGS
        set("grid", grid);
        set("columns", columns);
        set("rows", rows);
        set("depths", depths);
    }
};

/// Light indices of 16 or 32 bits, as KernelFeatures::light_index_bits says.
using LightIndexBytes = DeviceArray<std::byte>;

/// Ascending light indices of each coarse cluster: lists[offsets[c] .. offsets[c + 1]).
struct CoarseLists {
    DeviceArray<uint> offsets;  // [cluster_count + 1]
    LightIndexBytes lists;      // [capacity] indices
    uint capacity = 0;
    DeviceArray<std::uint64_t> total;  // indices, whether or not there was room

    void each(auto&& set) const {  // COARSE_LIST_ARGS
        set("coarse_offsets", offsets);
        set("coarse_lists", lists);
        set("coarse_capacity", capacity);
    }
};

/// Active clusters of each fine tile: clusters[offsets[tile] .. offsets[tile + 1]).
struct ActiveClusters {
    ClusterGrid grid{};
    DeviceArray<uint> offsets;            // [tile_count + 1]
    DeviceArray<ActiveCluster> clusters;  // [capacity]
    uint capacity = 0;
    uint tile_count = 0;
    // [tile_count][FINE_TILE_PIXELS]: row * FINE_TILE + column of a tile's pixels, cluster by
    // cluster and then background; undefined in tiles without clusters, and after the pixels of the
    // picture's last rows.
    DeviceArray<std::uint8_t> order;
    DeviceArray<std::uint8_t> occupied;  // [cluster_count]: 1 for coarse clusters with active ones

    void each(auto&& set) const {  // CLUSTER_ARGS
        set("grid", grid);
        set("cluster_offsets", offsets);
        set("clusters", clusters);
        set("cluster_capacity", capacity);
        set("order", order);
    }
};

/// Lists of the active clusters, where ActiveCluster::list_begin and list_count say.
struct RefinedLists {
    LightIndexBytes lists;  // [capacity] indices
    uint capacity = 0;

    void each(auto&& set) const {  // LIST_ARGS
        set("lists", lists);
        set("list_capacity", capacity);
    }
};

/// The sample counts at which the two halves of a fine tile's samples stopped; 0: not yet. A tile
/// is done when both have stopped.
struct TileCounts {
    DeviceArray<uint> fixed;  // [2][tile_count]
};

/// What shading a frame's pixels reads.
struct LitPixels {
    GBuffer gbuffer;
    PreparedLights lights;
    ActiveClusters clusters;
    RefinedLists refined;

    void each(auto&& set) const {  // LIT_ARGS
        set(gbuffer);
        set(lights);
        set(clusters);
        set(refined);
    }
};

/// Linear HDR radiance as three planes, and after them three for each group of lights.
struct Radiance {
    static constexpr std::size_t kPixelBytes = 3 * sizeof(float);
    DeviceArray<float> planes;  // [3 + 3 groups][height][stride]; empty where shading wrote to a
                                // DisplayTarget
    View view{};
    uint groups = 0;

    std::size_t plane_size() const { return std::size_t{view.stride} * view.height; }
    uint plane_count() const { return 3 * (1 + groups); }
    std::size_t floats() const { return plane_count() * plane_size(); }
};

/// Light that the display shows as a code of its own, whatever the tone curve makes of it.
struct Backdrop {
    static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    float4 light{kNone, kNone, kNone, kNone};  // x, y, z: before exposure
    uint code = 0;                             // R | G << 8 | B << 16 | 255 << 24

    void each(auto&& set) const {
        set("backdrop", light);
        set("backdrop_code", code);
    }
};

/// Where a display's sRGB codes go, and how radiance becomes codes.
struct DisplayTarget {
    static constexpr std::size_t kPixelBytes = sizeof(uint);
    DeviceArray<uint> pixels;  // [height][stride]: R | G << 8 | B << 16 | 255 << 24
    View view{};
    int tone_curve = 0;  // TONE_CURVE_*
    float gain = 1.0f;   // 2^exposure

    void each(auto&& set) const {  // DISPLAY_ARGS
        set("gain", gain);
        set(SrgbBucketTables{});
        set("display", pixels);
    }
};

}  // namespace kilolux
