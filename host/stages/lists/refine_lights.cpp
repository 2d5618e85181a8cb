// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/refine_lights.h"

namespace kilolux {
namespace {

constexpr std::size_t kFirstEntries = std::size_t{1} << 20;

BuildOptions options_of(const Tuning& tuning, const KernelFeatures& features) {
    return BuildOptions()
        .define("GROUP", tuning.refine_group)
        .define("HAS_SPOT_LIGHTS", features.spot_lights)
        .define("LIGHT_INDEX", light_index_type(features));
}

}  // namespace

RefineLights::RefineLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      program_(build_program(gpu, kRefineLightsStage, options_of(tuning, features))),
      reserve_(gpu, program_, kRefineLightsStage, "refine_lights_reserve"),
      refine_(gpu, program_, kRefineLightsStage, "refine_lights"),
      lists_(gpu, tuning, kRefineLightsStage, "tests of lights against active clusters",
             light_index_bytes(features)) {
    lists_.reserve(kFirstEntries);
}

RefinedLists RefineLights::enqueue(const PreparedLights& lights, const CoarseLists& coarse,
                                   const ActiveClusters& clusters, const View& view,
                                   StageTimer& timer) {
    const uint tiles = clusters.tile_count;
    RefinedLists out{lists_.entries<std::byte>(), lists_.capacity()};
    reserve_.enqueue(items(tiles, tuning_.light_group), timer, view, clusters, tiles, coarse,
                     lists_.counts(tiles));
    const DeviceArray<uint> offsets = lists_.enqueue_offsets(tiles, timer);
    refine_.enqueue(groups(tiles, tuning_.refine_group), timer, lights, view, coarse, clusters,
                    offsets, out);
    return out;
}

StageWork refine_lights_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.tiles);
    work.bytes_read += 2.0 * sizeof(ActiveCluster) * c.active_clusters;
    // A light tree adds further entries afterwards.
    work.bytes_written += kWordBytes * c.tiles + 2.0 * kWordBytes * c.active_clusters +
                          c.index_bytes() * std::min(c.refined_pairs, c.refine_tests);
    work.launches += 2;
    work.evaluations = c.refine_tests;
    return work;
}

}  // namespace kilolux
