// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/light_lists.h"

namespace kilolux {

ListStages::ListStages(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      index_bits_(features.light_index_bits),
      coarse_(gpu, tuning, features),
      bin_(gpu, tuning, features),
      refine_(gpu, tuning, features) {}

LightLists ListStages::enqueue(const LightInput& input, const GBuffer& gbuffer,
                               const ClusterGrid& grid, StageTimer& timer) {
    const ActiveClusters active = bin_.enqueue(gbuffer, grid, timer);
    const CoarseResult coarse =
        coarse_.enqueue(input, gbuffer.view, grid, timer,
                        everywhere_ ? DeviceArray<std::uint8_t>() : active.occupied);
    LightLists lists{coarse.lights, coarse.boxes, coarse.lists, active, {}};
    lists.refined =
        refine_.enqueue(lists.lights, lists.coarse, lists.clusters, gbuffer.view, grid, timer);
    return lists;
}

bool ListStages::fit() {
    // The later stages' needs are known only once the earlier ones are complete.
    const bool coarse = coarse_.fit();
    const bool active = bin_.fits();
    return coarse && active && refine_.fits();
}

void ListStages::count(const LightLists& lists, FrameStats& stats) const {
    const ClusterGrid& grid = lists.boxes.grid;
    stats.grid[0] = grid.tiles_x;
    stats.grid[1] = grid.tiles_y;
    stats.grid[2] = grid.slices;
    stats.coarse_pairs = coarse_.pairs();
    stats.active_clusters = bin_.active();
    stats.refine_tests = refine_.tests();
    stats.refined_pairs = 0;
    stats.drawn_pixels = 0;
    double evaluations = 0.0;
    for (const ActiveCluster& cluster :
         download<ActiveCluster>(gpu_, lists.clusters.clusters, stats.active_clusters)) {
        stats.refined_pairs += cluster.list_count;
        stats.drawn_pixels += cluster.pixel_count;
        evaluations += static_cast<double>(cluster.list_count) * cluster.pixel_count;
    }
    stats.evaluations_per_pixel =
        stats.drawn_pixels > 0 ? evaluations / static_cast<double>(stats.drawn_pixels) : 0.0;
}

std::vector<ActiveCluster> ListStages::clusters(const LightLists& lists) const {
    return download<ActiveCluster>(gpu_, lists.clusters.clusters, bin_.active());
}

void ListStages::probe(const LightLists& lists, const View& view, int x, int y,
                       PixelProbe& probe) const {
    const uint coarse = cluster_index(probe.grid, probe.tile_x, probe.tile_y, probe.slice);
    const auto ends = download<uint>(gpu_, lists.coarse.offsets, 2, coarse);
    probe.coarse_count = ends[1] - ends[0];
    const uint tile = fine_tile_of(view, static_cast<uint>(x), static_cast<uint>(y));
    const auto range = download<uint>(gpu_, lists.clusters.offsets, 2, tile);
    for (const ActiveCluster& cluster :
         download<ActiveCluster>(gpu_, lists.clusters.clusters, range[1] - range[0], range[0])) {
        if (cluster.slice != probe.fine_slice) continue;
        probe.active = cluster;
        probe.has_list = true;
        for (const uint light : download_indices(gpu_, lists.refined.lists, index_bits_,
                                                 cluster.list_count, cluster.list_begin)) {
            probe.lights.push_back({light, {}, {}});
        }
    }
}

HostCoarseLists ListStages::download_coarse(const LightLists& lists) const {
    return coarse_.download({lists.lights, lists.boxes, lists.coarse});
}

}  // namespace kilolux
