// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "host/gpu/flow.h"
#include "host/gpu/stage_info.h"
#include "host/stages/lists/prefix_sum.h"

namespace kilolux {

StageWork refine_lights_work(const StageCounts& counts);
inline constexpr StageInfo kRefineLightsStage = {"refine_lights", StageGroup::lists,
                                                 refine_lights_work};

/// Refines the coarse list of each active cluster against the box of its pixels.
class RefineLights {
 public:
    RefineLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Sets list_begin and list_count of every active cluster. Enqueues only.
    RefinedLists enqueue(const PreparedLights& lights, const CoarseLists& coarse,
                         const ActiveClusters& clusters, const View& view, StageTimer& timer);

    /// Lights that the last enqueue tested, once for each active cluster: on the device; on the
    /// host, which blocks.
    DeviceArray<std::uint64_t> total() const { return lists_.total(); }
    std::uint64_t tests() const { return lists_.read_total(); }

    /// True if there is room for the last enqueue's `tests`; else makes room for the next. Right
    /// only once coarse lists and active clusters fit. Without a number it blocks to read it.
    bool fits(std::uint64_t tests) { return lists_.fits(tests); }
    bool fits() { return fits(tests()); }

 private:
    Tuning tuning_;
    int group_;  // work-items that share a tile
    KernelProgram program_;
    Kernel reserve_, refine_;
    std::optional<Kernel> make_blocks_;  // of long lists
    GrowingArray<float4> blocks_;        // two a block
    CountedList lists_;
};

}  // namespace kilolux
