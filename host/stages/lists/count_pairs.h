// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/memory/host_value.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kCountPairsStage = {"count_pairs", StageGroup::lists};

/// The totals of the list stages' last calls: one element each, on the device.
struct ListTotals {
    DeviceArray<std::uint64_t> coarse_pairs;     // CullLights::total()
    DeviceArray<std::uint64_t> active_clusters;  // BinPixels::total()
    DeviceArray<std::uint64_t> refine_tests;     // RefineLights::total()
};

/// Gathers the totals of a frame's lists and the sums over its active clusters in one place, and
/// copies their 48 bytes to the host, which show whether the lists fit and what they hold:
///
///     count_pairs.enqueue(...);
///     ...                                            // what the device does meanwhile
///     const PairCounts counts = count_pairs.read();  // waits for the counts
///     const bool coarse = cull.fits(counts.coarse_pairs), active =
///     bin.fits(counts.active_clusters); const bool complete = coarse && active &&
///     refine.fits(counts.refine_tests);
class CountPairs {
 public:
    CountPairs(const Gpu& gpu, const Tuning& tuning);

    /// Enqueues only. Without `sums` only the totals are gathered, and PairCounts' sums are 0. The
    /// sums mean nothing unless all lists fit. Returns one element.
    DeviceArray<PairCounts> enqueue(const ListTotals& totals, const ActiveClusters& clusters,
                                    bool sums, StageTimer& timer);

    /// The counts of the last enqueue. Waits for them.
    PairCounts read() const { return copy_.get(); }

 private:
    int group_;
    KernelProgram program_;
    Kernel sum_shares_, gather_;
    GrowingArray<std::uint64_t> shares_;
    GrowingArray<PairCounts> counts_;
    HostValue<PairCounts> copy_;
};

}  // namespace kilolux
