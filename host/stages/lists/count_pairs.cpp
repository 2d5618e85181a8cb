// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/count_pairs.h"

#include <algorithm>

namespace kilolux {
namespace {

// Work-groups that sum clusters: enough to fill a GPU, few enough for one of them to join.
constexpr uint kShares = 256;
// Sums of 32 bytes in local memory.
constexpr int kLargestGroup = 64;
constexpr std::size_t kSumsOfShare = 4;  // a ulong4

}  // namespace

CountPairs::CountPairs(const Gpu& gpu, const Tuning& tuning)
    : group_(std::min(tuning.light_group, kLargestGroup)),
      program_(build_program(gpu, kCountPairsStage, BuildOptions().define("GROUP", group_))),
      sum_shares_(gpu, program_, kCountPairsStage, "count_pairs_sum_shares"),
      gather_(gpu, program_, kCountPairsStage, "count_pairs"),
      shares_(gpu, kCountPairsStage),
      counts_(gpu, kCountPairsStage),
      copy_(gpu) {
    shares_.reserve(kShares * kSumsOfShare);
    counts_.reserve(1);
}

DeviceArray<PairCounts> CountPairs::enqueue(const ListTotals& totals,
                                            const ActiveClusters& clusters, bool sums,
                                            StageTimer& timer) {
    const auto share_count = sums ? kShares : 0u;
    if (sums) {
        sum_shares_.enqueue(groups(kShares, group_), timer, clusters, totals.active_clusters,
                            shares_.get());
    }
    gather_.enqueue(groups(1, group_), timer, totals.coarse_pairs, totals.active_clusters,
                    totals.refine_tests, shares_.get(), share_count, counts_.get());
    copy_.start(counts_.get(), kCountPairsStage, timer);
    return counts_.get();
}

}  // namespace kilolux
