// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "host/certify/synthetic/vec3d.h"
#include "host/stages/bin_pixels.h"
#include "host/stages/build_clusters.h"
#include "host/stages/cull_lights.h"
#include "host/stages/decode_gbuffer.h"
#include "host/stages/prepare_lights.h"
#include "host/stages/refine_lights.h"
#include "kernels/shared/surface_planes.h"

namespace kilolux {

/// What the list stages made, on the device.
struct DeviceLists {
    PreparedLights lights;
    ClusterBoxes boxes;
    CoarseLists coarse;
    ActiveClusters clusters;
    RefinedLists refined;
};

/// The list stages in their order, each repeated until its room suffices.
class StageRun {
 public:
    StageRun(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);
    DeviceLists run(const LightInput& lights, const GBuffer& gbuffer, const ClusterGrid& grid);
    CullLights& cull() { return cull_; }

 private:
    PrepareLights prepare_;
    BuildClusters build_;
    CullLights cull_;
    BinPixels bin_;
    RefineLights refine_;
};

/// Lists on the host, indices widened to 32 bits.
struct HostLists {
    std::vector<uint> coarse_offsets, coarse;
    std::vector<uint> cluster_offsets;  // of the fine tiles
    std::vector<ActiveCluster> clusters;
    std::vector<uint> refined;

    std::span<const uint> coarse_of(std::size_t cluster) const {
        return std::span(coarse).subspan(coarse_offsets[cluster],
                                         coarse_offsets[cluster + 1] - coarse_offsets[cluster]);
    }
    std::span<const uint> refined_of(const ActiveCluster& c) const {
        return std::span(refined).subspan(c.list_begin, c.list_count);
    }
    /// The active cluster of a fine tile and slice; null if there is none.
    const ActiveCluster* find(uint tile, uint slice) const;
};

HostLists download_lists(const Gpu& gpu, const KernelFeatures& features, const ClusterGrid& grid,
                         const DeviceLists& lists);

/// One text that differs if anything in the lists does, but for where they lie in memory.
std::string fingerprint(const HostLists& lists);

/// Decoded planes on the host.
struct Planes {
    View view{};
    std::vector<float> values;

    float at(uint plane, uint x, uint y) const {
        const std::size_t size = std::size_t{view.stride} * view.height;
        return values[plane * size + std::size_t{y} * view.stride + x];
    }
    Vec3d vector(uint plane, uint x, uint y) const {
        return {at(plane, x, y), at(plane + 1, x, y), at(plane + 2, x, y)};
    }
};

Planes decode(const Gpu& gpu, const KernelFeatures& features, const GBuffer& gbuffer);

inline uint fine_tile(const View& view, uint x, uint y) { return fine_tile_of(view, x, y); }

/// The grid whose slices are those of active clusters.
ClusterGrid fine_grid(ClusterGrid grid);

/// Slice of a depth by searching the slices' ends: the definition, without bit tricks.
uint slice_by_search(const ClusterGrid& grid, double z);

}  // namespace kilolux
