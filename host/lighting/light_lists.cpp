// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/light_lists.h"

namespace kilolux {

LightLists::LightLists(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      index_bits_(features.light_index_bits),
      coarse_(gpu, tuning, features),
      bin_(gpu, tuning, features),
      refine_(gpu, tuning, features) {}

ListedLights LightLists::run(const LightInput& input, const GBuffer& gbuffer,
                             const ClusterGrid& grid, StageTimer& timer,
                             const std::function<void(const ListedLights&)>& then) {
    for (;;) {
        const ListedLights lists = enqueue(input, gbuffer, grid, timer);
        if (then) then(lists);
        if (fits()) {
            count(lists);
            return lists;
        }
        timer.take();  // of lists that had no room
    }
}

ListedLights LightLists::enqueue(const LightInput& input, const GBuffer& gbuffer,
                                 const ClusterGrid& grid, StageTimer& timer) {
    const ActiveClusters active = bin_.enqueue(gbuffer, grid, timer);
    const CoarseLighting coarse = coarse_.enqueue(input, gbuffer.view, grid, timer,
                                                  everywhere_ ? cl::Buffer() : active.occupied);
    return {grid,
            coarse.lights,
            coarse.boxes,
            coarse.lists,
            active,
            refine_.enqueue(coarse.lights, coarse.lists, active, gbuffer.view, grid, timer)};
}

// The later stages' needs are known only once the earlier ones are complete.
bool LightLists::fits() {
    const bool coarse = coarse_.fits();
    const bool active = bin_.fits();
    return coarse && active && refine_.fits();
}

void LightLists::count(const ListedLights& lists) {
    counts_ = {coarse_.pairs(), bin_.active(), refine_.tests(), 0, 0, 0};
    for (const ActiveCluster& cluster : active_clusters(lists)) {
        counts_.refined_pairs += cluster.list_count;
        counts_.drawn_pixels += cluster.pixel_count;
        counts_.evaluations += std::uint64_t{cluster.list_count} * cluster.pixel_count;
    }
}

PixelLists LightLists::at_pixel(const ListedLights& lists, const View& view, uint x, uint y,
                                float z) const {
    const ClusterGrid& grid = lists.grid;
    PixelLists out;
    const uint coarse =
        cluster_index(grid, x / grid.tile_width, y / grid.tile_height, slice_of_depth(grid, z));
    const auto ends = download<uint>(gpu_, lists.coarse.offsets, 2, coarse);
    out.coarse_count = ends[1] - ends[0];
    const uint tile = y / FINE_TILE * ((view.width + FINE_TILE - 1) / FINE_TILE) + x / FINE_TILE;
    const auto range = download<uint>(gpu_, lists.clusters.offsets, 2, tile);
    for (const ActiveCluster& cluster :
         download<ActiveCluster>(gpu_, lists.clusters.clusters, range[1] - range[0], range[0])) {
        if (cluster.slice != fine_slice_of_depth(grid, z)) continue;
        out.active = cluster;
        out.lights = download_indices(gpu_, lists.refined.lists, index_bits_, cluster.list_count,
                                      cluster.list_begin);
    }
    return out;
}

std::vector<ActiveCluster> LightLists::active_clusters(const ListedLights& lists) const {
    return download<ActiveCluster>(gpu_, lists.clusters.clusters, counts_.active_clusters);
}

HostCoarseLists LightLists::download_coarse(const ListedLights& lists) const {
    return coarse_.download({lists.lights, lists.boxes, lists.coarse});
}

}  // namespace kilolux
