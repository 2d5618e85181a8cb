// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"
#include "host/stages/prefix_sum.h"

namespace kilolux {

/// Lists, for each coarse cluster, the lights whose sphere (and cone) touches the cluster's box.
///
/// A stable counting sort: count by (chunk, cluster), prefix sum, fill. No light is ever left out:
/// the lists have as many entries as there are pairs. enqueue() works with the room of the last
/// frame; when that was too little, fits() grows it and the caller enqueues the frame's lists
/// again.
class CullLights {
 public:
    CullLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Enqueues only. Lists ascend by light index within a cluster, whatever the tuning.
    /// `occupied`: ActiveClusters'; clusters that are not have empty lists. None: all have lists.
    CoarseLists enqueue(const PreparedLights& lights, const ClusterBoxes& boxes, StageTimer& timer,
                        const cl::Buffer& occupied = {});

    /// The brute-force kernel: every light against every cluster's box; blocks. The oracle. Lists
    /// are enqueue()'s plus lights that touch only the part of a box outside the cluster's part of
    /// the frustum.
    CoarseLists brute_force(const PreparedLights& lights, const ClusterBoxes& boxes,
                            StageTimer& timer);

    /// Pairs of the last enqueue; blocks until it is done.
    std::uint64_t pairs() const { return prefix_sum_.total(); }

    /// True if the last enqueue's lists are complete; else makes room for the next. Blocks.
    /// Throws Error when the pairs exceed what 32-bit offsets or the device can hold.
    bool fits();

 private:
    std::size_t cursor_stride(const ClusterGrid& grid) const;
    CoarseLists make_lists(const ClusterGrid& grid);

    Gpu gpu_;
    Tuning tuning_;
    std::size_t index_bytes_;
    cl::Program program_;
    PrefixSum prefix_sum_;
    GrowingBuffer cursors_, counts_, offsets_, lists_;
};

}  // namespace kilolux
