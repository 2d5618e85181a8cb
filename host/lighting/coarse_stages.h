// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/picture/frame.h"
#include "host/stages/build_clusters.h"
#include "host/stages/cull_lights.h"
#include "host/stages/prepare_lights.h"

namespace kilolux {

/// What the stages from lights to coarse lists made.
struct CoarseResult {
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

/// The stages from lights to the coarse grid's lists.
class CoarseStages {
 public:
    CoarseStages(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Enqueues all of them with the room that earlier frames needed. `occupied`: see
    /// CullLights.
    CoarseResult enqueue(const LightInput& input, const View& view, const ClusterGrid& grid,
                         StageTimer& timer, const DeviceArray<std::uint8_t>& occupied = {});

    /// True if the lists of the last enqueue are complete; else room has grown: enqueue again.
    /// Blocks.
    bool fit() { return cull_.fits(); }

    /// Pairs of the last enqueue. Blocks.
    std::uint64_t pairs() const { return cull_.pairs(); }

    /// Copies the lists of the last enqueue, which must fit. Blocks.
    HostCoarseLists download(const CoarseResult& result) const;

 private:
    Gpu gpu_;
    int index_bits_;
    PrepareLights prepare_;
    BuildClusters build_;
    CullLights cull_;
};

}  // namespace kilolux
