// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/refine_lights.h"

namespace kilolux {
namespace {

constexpr std::size_t kFirstEntries = std::size_t{1} << 20;

// BLOCK of kernels/lists/refine_lights.cl, and work-groups that find the blocks of a cluster.
// NVIDIA H200, a million lights: 8 groups take 0.03 ms. 32 take 0.10 ms: most find no work.
constexpr std::size_t kListBlock = 32, kBlockParts = 8;
constexpr std::size_t kBlockRows = 2;

// Lists of so many lights that their indices need 32 bits are long enough to gain by blocks.
bool has_blocks(const KernelFeatures& features) { return features.light_index_bits == 32; }

// A long list keeps more work-items busy. NVIDIA H200, a million lights: 64, 128 and 256 take 0.18,
// 0.12 and 0.13 ms.
int doubled_if_long(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features) {
    const int group = tuning.refine_group;
    const bool is_long = group > 1 && has_blocks(features);
    return is_long ? std::max(group, std::min(2 * group, fitting_group(256, gpu.info))) : group;
}

BuildOptions options_of(int group, const KernelFeatures& features) {
    return BuildOptions()
        .define("GROUP", group)
        .define("BLOCK", has_blocks(features) ? kListBlock : 0)
        .define("PARTS", kBlockParts)
        .define("HAS_SPOT_LIGHTS", features.spot_lights)
        .define("LIGHT_INDEX", light_index_type(features));
}

// What refining reads beside lights and lists.
struct TileInput {
    DeviceArray<uint> reserves;  // where each tile's lists begin
    DeviceArray<float4> blocks;  // empty: none

    void each(auto&& set) const {
        set("list_offsets", reserves);
        set("blocks", blocks);
    }
};

}  // namespace

RefineLights::RefineLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      group_(doubled_if_long(gpu, tuning, features)),
      program_(build_program(gpu, kRefineLightsStage, options_of(group_, features))),
      reserve_(gpu, program_, kRefineLightsStage, "refine_lights_reserve"),
      refine_(gpu, program_, kRefineLightsStage, "refine_lights"),
      blocks_(gpu, kRefineLightsStage),
      lists_(gpu, tuning, kRefineLightsStage, "tests of lights against active clusters",
             light_index_bytes(features)) {
    lists_.reserve(kFirstEntries);
    if (has_blocks(features))
        make_blocks_.emplace(gpu, program_, kRefineLightsStage, "refine_lights_blocks");
}

RefinedLists RefineLights::enqueue(const PreparedLights& lights, const CoarseLists& coarse,
                                   const ActiveClusters& clusters, const View& view,
                                   StageTimer& timer) {
    const uint tiles = clusters.tile_count;
    RefinedLists out{lists_.entries<std::byte>(), lists_.capacity()};
    reserve_.enqueue(items(tiles, tuning_.light_group), timer, view, clusters, tiles, coarse,
                     lists_.counts(tiles));
    TileInput input{lists_.enqueue_offsets(tiles, timer), {}};
    if (make_blocks_) {
        const std::size_t coarse_clusters = clusters.grid.cluster_count;
        // The last block of a list may be a part of one.
        input.blocks =
            blocks_.reserve(kBlockRows * (coarse.capacity / kListBlock + coarse_clusters));
        make_blocks_->enqueue(groups(kBlockParts * coarse_clusters, group_), timer, lights, coarse,
                              input.blocks);
    }
    refine_.enqueue(groups(tiles, group_), timer, lights, view, coarse, clusters, input, out);
    return out;
}

StageWork refine_lights_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.tiles);
    work.bytes_read += 2.0 * sizeof(ActiveCluster) * c.active_clusters;
    // A light tree adds further entries afterwards.
    work.bytes_written += kWordBytes * c.tiles + 2.0 * kWordBytes * c.active_clusters +
                          c.index_bytes() * std::min(c.refined_pairs, c.refine_tests);
    work.launches += has_blocks(c.kernels) ? 3 : 2;
    // By blocks not all are tested, but those that are listed.
    work.evaluations =
        has_blocks(c.kernels) ? std::min(c.refined_pairs, c.refine_tests) : c.refine_tests;
    return work;
}

}  // namespace kilolux
