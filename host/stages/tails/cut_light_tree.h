// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/gpu/flow.h"
#include "host/gpu/stage_info.h"
#include "host/stages/lists/prefix_sum.h"

namespace kilolux {

StageWork cut_light_tree_work(const StageCounts& counts);
inline constexpr StageInfo kCutLightTreeStage = {"cut_light_tree", StageGroup::lists,
                                                 cut_light_tree_work};

/// A frame's pixels, lights and lists.
struct CutInput {
    GBuffer gbuffer;
    PreparedLights lights;                         // with nodes
    ActiveClusters clusters;                       // lists as refine_lights set them
    DeviceArray<std::uint64_t> active_clusters{};  // BinPixels::total()
    RefinedLists refined;
};

/// Appends each active cluster's cut through the light tree to its list: nodes that replace their
/// lights within a share of the light that they send, and single lights. See
/// kernels/tails/tree_cut.h.
class CutLightTree {
 public:
    CutLightTree(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// The lists with the cuts; sets list_begin and list_count of every active cluster. Enqueues
    /// only.
    RefinedLists enqueue(const CutInput& input, StageTimer& timer);

    /// Entries of the last enqueue's lists. Blocks.
    std::uint64_t entries() const { return lists_.read_total(); }

    /// True if there is room for the last enqueue's `entries`; else makes room for the next. Valid
    /// only once all inputs are complete.
    bool fits(std::uint64_t entries) { return lists_.fits(entries); }

 private:
    Tuning tuning_;
    float share_;
    Kernel cones_, count_, fill_;
    CountedList lists_;
    GrowingBuffer cone_rows_;
};

}  // namespace kilolux
