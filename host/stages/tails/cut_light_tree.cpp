// SPDX-License-Identifier: Apache-2.0
#include "host/stages/tails/cut_light_tree.h"

#include "host/base/srgb.h"

namespace kilolux {
namespace {

constexpr std::size_t kConeBytes = 32;  // ClusterCone of kernels/tails/tree_cut.h
constexpr std::size_t kFirstCutEntries = std::size_t{1} << 20;

}  // namespace

CutLightTree::CutLightTree(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      share_(features.tree_share),
      cones_(gpu, build_program(gpu.with_lanes(1), "tree_cones", feature_options(features)),
             kCutLightTreeStage, "tree_cones"),
      count_(gpu, build_program(gpu, kCutLightTreeStage, feature_options(features)),
             kCutLightTreeStage, "cut_light_tree_count"),
      fill_(gpu, build_program(gpu, kCutLightTreeStage, feature_options(features)),
            kCutLightTreeStage, "cut_light_tree_fill"),
      lists_(gpu, tuning, kCutLightTreeStage, light_index_bytes(features)),
      srgb_(gpu, kCutLightTreeStage),
      cone_rows_(gpu, kCutLightTreeStage) {
    lists_.reserve(kFirstCutEntries);
    const auto table = srgb_to_linear_table();
    upload<float>(gpu_, srgb_.reserve(table.size()), table);
}

RefinedLists CutLightTree::enqueue(const CutInput& input, StageTimer& timer) {
    const ActiveClusters& clusters = input.clusters;
    const PreparedLights& lights = input.lights;
    const RefinedLists out{lists_.entries<std::byte>(), lists_.capacity()};
    cone_rows_.reserve(clusters.capacity * kConeBytes);
    const auto cones = cone_rows_.array<std::byte>(clusters.capacity * kConeBytes);
    const GBuffer& g = input.gbuffer;
    cones_.enqueue(items(clusters.tile_count, tuning_.light_group), timer, g.bytes, g.layout,
                   g.view, srgb_.get(), clusters.offsets, clusters.clusters, clusters.capacity,
                   clusters.tile_count, clusters.order, cones);
    const auto lanes = static_cast<std::size_t>(gpu_.info.lane_width);
    const WorkSize walks = items((clusters.capacity + lanes - 1) / lanes, tuning_.light_group);
    count_.enqueue(walks, timer, clusters.clusters, clusters.capacity, input.active_clusters, cones,
                   lights.nodes, lights.bounds, lights.count, lights.node_count, share_,
                   lists_.counts(clusters.capacity));
    const DeviceArray<uint> offsets = lists_.enqueue_offsets(clusters.capacity, timer);
    fill_.enqueue(walks, timer, clusters.clusters, clusters.capacity, input.active_clusters, cones,
                  lights.nodes, lights.bounds, lights.count, lights.node_count, share_,
                  input.refined.lists, offsets, out.lists, out.capacity);
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
