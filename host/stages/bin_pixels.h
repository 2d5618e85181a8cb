// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"
#include "host/stages/prefix_sum.h"

namespace kilolux {

/// Finds the active clusters: per fine tile, one for each slice among its pixels, with their box.
/// And puts the tile's pixels in their order.
class BinPixels {
 public:
    BinPixels(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Enqueues only.
    ActiveClusters enqueue(const GBuffer& gbuffer, const ClusterGrid& grid, StageTimer& timer);

    /// Active clusters of the last enqueue; blocks.
    std::uint64_t active() const { return prefix_sum_.total(); }

    /// True if the last enqueue's clusters are complete; else makes room for the next. Blocks.
    bool fits();

 private:
    cl::Buffer cleared_occupied(const ClusterGrid& grid, StageTimer& timer);

    Gpu gpu_;
    Tuning tuning_;
    cl::Program program_;
    PrefixSum prefix_sum_;
    GrowingBuffer counts_, offsets_, clusters_, order_, occupied_;
};

}  // namespace kilolux
