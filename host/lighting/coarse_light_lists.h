// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/stages/lights/prepare_lights.h"
#include "host/stages/lists/build_clusters.h"
#include "host/stages/lists/cull_lights.h"

namespace kilolux {

/// Lights in view space and the lists of the coarse grid's clusters, on the device.
struct CoarseLighting {
    PreparedLights lights;
    ClusterBoxes boxes;
    CoarseLists lists;
};

/// Coarse lists on the host, indices widened to 32 bits.
struct HostCoarseLists {
    ClusterGrid grid{};
    std::vector<uint> offsets;  // [cluster_count + 1]
    std::vector<uint> lists;
};

/// The stages from lights to the lists of the coarse grid: PrepareLights, BuildClusters,
/// CullLights. Throws Error where buffers of lights are smaller than their counts say.
class CoarseLightLists {
 public:
    CoarseLightLists(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// The complete lists; runs again where they have grown. Blocks. Valid until the next call.
    CoarseLighting run(const LightInput& input, const View& view, const ClusterGrid& grid,
                       StageTimer& timer);

    /// Enqueues the stages with the room that earlier calls needed. `occupied`: see CullLights.
    CoarseLighting enqueue(const LightInput& input, const View& view, const ClusterGrid& grid,
                           StageTimer& timer, const DeviceArray<std::uint8_t>& occupied = {});

    /// (light, cluster) pairs of the last enqueue(): on the device; on the host, which blocks.
    DeviceArray<std::uint64_t> total() const { return cull_.total(); }
    std::uint64_t pairs() const { return cull_.pairs(); }

    /// True if there is room for the last enqueue's `pairs`; else makes room for the next.
    bool fits(std::uint64_t pairs) { return cull_.fits(pairs); }

    /// Copies complete lists. Blocks.
    HostCoarseLists download(const CoarseLighting& coarse) const;

 private:
    Gpu gpu_;
    int index_bits_;
    PrepareLights prepare_;
    BuildClusters build_;
    CullLights cull_;
};

}  // namespace kilolux
