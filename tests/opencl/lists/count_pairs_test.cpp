// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/count_pairs.h"

#include <gtest/gtest.h>

#include "host/certify/synthetic/random.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

DeviceArray<std::uint64_t> one(const Gpu& gpu, std::uint64_t value) {
    return {new_buffer(gpu, std::vector<std::uint64_t>{value, 0}), 1};
}

// Sums that exceed 32 bits, from numbers of all sizes.
std::vector<ActiveCluster> random_clusters(std::size_t count) {
    Random random(static_cast<std::uint32_t>(count) + 1);
    std::vector<ActiveCluster> clusters(count);
    for (ActiveCluster& cluster : clusters) {
        cluster.list_count = random.bits() >> random.below(32);
        cluster.pixel_count = random.below(257);
    }
    return clusters;
}

TEST(CountPairs, AgreesWithTheSumOnTheHost) {
    const Gpu gpu = test_gpu();
    for (const int group : {1, 4, 64, 256}) {
        Tuning tuning;
        tuning.light_group = group;
        CountPairs stage(gpu, tuning);
        for (const std::size_t count : {0u, 1u, 63u, 1025u, 5000u}) {
            SCOPED_TRACE(std::to_string(group) + " items, " + std::to_string(count) + " clusters");
            const std::vector<ActiveCluster> host = random_clusters(count);
            ActiveClusters clusters;
            clusters.clusters = new_buffer(gpu, host);
            clusters.capacity = static_cast<uint>(count);
            PairCounts expected{
                (std::uint64_t{1} << 33) + 5, count, std::uint64_t{1} << 40, 0, 0, 0};
            for (const ActiveCluster& c : host) {
                expected.refined_pairs += c.list_count;
                expected.surface_pixels += c.pixel_count;
                expected.evaluations += std::uint64_t{c.list_count} * c.pixel_count;
            }
            StageTimer timer;
            const ListTotals totals{one(gpu, expected.coarse_pairs), one(gpu, count),
                                    one(gpu, expected.refine_tests)};
            stage.enqueue(totals, clusters, true, timer);
            const PairCounts found = stage.read();
            EXPECT_EQ(found.coarse_pairs, expected.coarse_pairs);
            EXPECT_EQ(found.active_clusters, expected.active_clusters);
            EXPECT_EQ(found.refine_tests, expected.refine_tests);
            EXPECT_EQ(found.refined_pairs, expected.refined_pairs);
            EXPECT_EQ(found.surface_pixels, expected.surface_pixels);
            EXPECT_EQ(found.evaluations, expected.evaluations);
        }
    }
}

TEST(CountPairs, ReadsNoClusterBeyondTheRoomAndNoneWhereOnlyTotalsAreAskedFor) {
    const Gpu gpu = test_gpu();
    std::vector<ActiveCluster> host(3);
    for (ActiveCluster& c : host) c.list_count = c.pixel_count = 1;
    ActiveClusters clusters;
    clusters.clusters = new_buffer(gpu, host);
    clusters.capacity = 2;
    CountPairs stage(gpu, default_tuning(gpu.info));
    StageTimer timer;
    const ListTotals totals{one(gpu, 7), one(gpu, 1000), one(gpu, 9)};
    stage.enqueue(totals, clusters, true, timer);
    EXPECT_EQ(stage.read().refined_pairs, 2u);
    stage.enqueue(totals, clusters, false, timer);
    EXPECT_EQ(stage.read().refined_pairs, 0u);
    EXPECT_EQ(stage.read().active_clusters, 1000u);
}

}  // namespace
}  // namespace kilolux
