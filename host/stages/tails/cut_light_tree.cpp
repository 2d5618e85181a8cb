// SPDX-License-Identifier: Apache-2.0
#include "host/stages/tails/cut_light_tree.h"

namespace kilolux {
namespace {

constexpr std::size_t kConeBytes = 32;  // ClusterCone of kernels/tails/tree_cut.h
constexpr std::size_t kFirstCutEntries = std::size_t{1} << 20;

// CUT_ARGS of the kernels.
struct TreeCut {
    const CutInput& input;
    DeviceArray<std::byte> cones;
    float share;

    void each(auto&& set) const {
        set(input.clusters);
        set("active_clusters", input.active_clusters);
        set("cones", cones);
        set(input.lights);
        set("share", share);
    }
};

}  // namespace

CutLightTree::CutLightTree(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      share_(features.tree_share),
      cones_(gpu, build_program(gpu.with_lanes(1), "tree_cones", feature_options(features)),
             kCutLightTreeStage, "tree_cones"),
      count_(gpu, build_program(gpu, kCutLightTreeStage, feature_options(features)),
             kCutLightTreeStage, "cut_light_tree_count"),
      fill_(gpu, build_program(gpu, kCutLightTreeStage, feature_options(features)),
            kCutLightTreeStage, "cut_light_tree_fill"),
      lists_(gpu, tuning, kCutLightTreeStage, "(light, active cluster) pairs",
             light_index_bytes(features)),
      cone_rows_(gpu, kCutLightTreeStage) {
    lists_.reserve(kFirstCutEntries);
}

RefinedLists CutLightTree::enqueue(const CutInput& input, StageTimer& timer) {
    const ActiveClusters& clusters = input.clusters;
    RefinedLists out{lists_.entries<std::byte>(), lists_.capacity()};
    cone_rows_.reserve(clusters.capacity * kConeBytes);
    const TreeCut cut{input, cone_rows_.array<std::byte>(clusters.capacity * kConeBytes), share_};
    cones_.enqueue(items(clusters.tile_count, tuning_.light_group), timer, input.gbuffer, clusters,
                   clusters.tile_count, cut.cones);
    const WorkSize walks = count_.vector_items(clusters.capacity, tuning_.light_group);
    count_.enqueue(walks, timer, cut, lists_.counts(clusters.capacity));
    const DeviceArray<uint> offsets = lists_.enqueue_offsets(clusters.capacity, timer);
    fill_.enqueue(walks, timer, cut, input.refined.lists, offsets, out);
    return out;
}

StageWork cut_light_tree_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.active_clusters);
    work.bytes_read += 2.0 * sizeof(ActiveCluster) * c.active_clusters;
    work.bytes_written += c.index_bytes() * c.refined_pairs;
    work.launches += 3;
    return work;
}

}  // namespace kilolux
