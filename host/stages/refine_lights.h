// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"
#include "host/stages/prefix_sum.h"

namespace kilolux {

/// Refines the coarse list of each active cluster against the box of its pixels.
class RefineLights {
 public:
    RefineLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Sets list_begin and list_count of every active cluster. Enqueues only.
    RefinedLists enqueue(const PreparedLights& lights, const CoarseLists& coarse,
                         const ActiveClusters& clusters, const View& view, const ClusterGrid& grid,
                         StageTimer& timer);

    /// Lights that the last enqueue tested, once for each active cluster; blocks.
    std::uint64_t tests() const { return prefix_sum_.total(); }

    /// True if the last enqueue's lists are complete; else makes room for the next. Blocks.
    bool fits();

 private:
    Gpu gpu_;
    Tuning tuning_;
    std::size_t index_bytes_;
    cl::Program program_;
    PrefixSum prefix_sum_;
    GrowingBuffer reserves_, offsets_, lists_;
};

}  // namespace kilolux
