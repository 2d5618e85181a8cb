// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/light_lists.h"

#include <cassert>
#include <cstring>
#include <utility>

#include "host/gpu/repeat_until_fits.h"
#include "host/lighting/check_input.h"

namespace kilolux {
namespace {

ListSource source_of(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid,
                     const MorePixels& more) {
    return {gbuffer.version, more.maker ? more.gbuffer.version : 0, input.version, input.seed,
            grid};
}

}  // namespace

LightLists::LightLists(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      index_bits_(features.light_index_bits),
      coarse_(gpu, tuning, features),
      bin_(gpu, tuning, features),
      refine_(gpu, tuning, features),
      count_(gpu, tuning) {
    if (features.light_tree) cut_.emplace(gpu, tuning, features);
}

bool LightLists::has_made(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid,
                          const MorePixels& more) const {
    return is_made_of(source_of(input, gbuffer, grid, more));
}

ListedLights LightLists::run(const LightInput& input, const GBuffer& gbuffer,
                             const ClusterGrid& grid, StageTimer& timer) {
    return repeat_until_fits(
        timer, [&] { return enqueue(input, gbuffer, grid, timer); }, [&] { return fits(timer); });
}

ListedLights LightLists::enqueue(const LightInput& input, const GBuffer& gbuffer,
                                 const ClusterGrid& grid, StageTimer& timer,
                                 const MorePixels& more) {
    check_input(gbuffer);
    check_input(grid, gbuffer.view);
    assert(!more.maker || gbuffer.version == 0 || more.gbuffer.version != 0);
    const ListSource source = source_of(input, gbuffer, grid, more);
    if (more.maker) more.maker->clusters_.reset();
    // They hold coarse lists of the last time, which may grow.
    if (more.maker && !is_made_of(source)) more.maker->made_.reset();
    return kept_or_made(source, [&] {
        const bool is_kept = is_binned(gbuffer, grid);
        const ActiveClusters active = active_of(gbuffer, grid, {}, timer);
        if (more.maker) {
            if (!is_kept) more.maker->binned_version_ = 0;  // `occupied` was cleared
            more.maker->find_clusters(more.gbuffer, grid, active.occupied, timer);
        }
        const CoarseLighting coarse =
            coarse_.enqueue(input, gbuffer.view, grid, timer,
                            everywhere_ ? DeviceArray<std::uint8_t>() : active.occupied);
        shares_coarse_ = false;
        return refined(coarse, active, gbuffer, timer);
    });
}

ListedLights LightLists::enqueue_sharing(const ListedLights& others, const GBuffer& gbuffer,
                                         StageTimer& timer) {
    check_input(gbuffer);
    check_input(others.grid, gbuffer.view);
    return kept_or_made({gbuffer.version, 0, others.version, 0, others.grid}, [&] {
        // Where the others were kept, their enqueue() did not look for the clusters, which their
        // `occupied` holds already.
        if (!clusters_) find_clusters(gbuffer, others.grid, others.clusters.occupied, timer);
        const ActiveClusters active = *std::exchange(clusters_, std::nullopt);
        shares_coarse_ = true;
        return refined({others.lights, others.boxes, others.coarse}, active, gbuffer, timer);
    });
}

bool LightLists::is_made_of(const ListSource& source) const {
    return made_ && is_checked_ && source.matches(made_of_);
}

void LightLists::forget() {
    made_.reset();
    clusters_.reset();
    active_ = {};
    binned_version_ = 0;
}

void LightLists::find_clusters(const GBuffer& gbuffer, const ClusterGrid& grid,
                               const DeviceArray<std::uint8_t>& occupied, StageTimer& timer) {
    made_.reset();
    if (needs_room_) grow();
    clusters_ = active_of(gbuffer, grid, occupied, timer);
}

template <typename Make>
ListedLights LightLists::kept_or_made(const ListSource& source, const Make& make) {
    if (is_made_of(source)) return *made_;
    made_.reset();  // arrays that grow must not be held twice
    is_checked_ = is_counting_ = false;
    if (needs_room_) grow();
    made_ = make();
    made_->version = ++version_;
    made_of_ = source;
    return *made_;
}

void LightLists::start_count(StageTimer& timer) {
    if (is_checked_ || std::exchange(is_counting_, true)) return;
    count_.enqueue({made_->coarse.total, bin_.total(), refine_.total()}, made_->clusters,
                   !shares_coarse_, timer);
}

bool LightLists::fits(StageTimer& timer) {
    if (is_checked_) {
        gpu_.queue.finish();
        return true;
    }
    start_count(timer);
    counts_ = count_.read();
    is_checked_ = is_complete(*made_);
    if (is_checked_) {
        binned_version_ = made_of_.gbuffer;
        binned_grid_ = made_of_.grid;
        return true;
    }
    needs_room_ = true;
    had_coarse_room_ = shares_coarse_ || counts_.coarse_pairs <= made_->coarse.capacity;
    made_.reset();
    active_ = {};
    binned_version_ = 0;
    return false;
}

bool ListSource::matches(const ListSource& other) const {
    return gbuffer != 0 && lights != 0 && gbuffer == other.gbuffer && more == other.more &&
           lights == other.lights && seed == other.seed &&
           std::memcmp(&grid, &other.grid, sizeof grid) == 0;
}

bool LightLists::is_complete(const ListedLights& lists) const {
    return counts_.coarse_pairs <= lists.coarse.capacity &&
           counts_.active_clusters <= lists.clusters.capacity &&
           counts_.refine_tests <= refine_room_ &&
           (lists.lights.node_count == 0 || cut_->entries() <= lists.refined.capacity);
}

void LightLists::grow() {
    needs_room_ = false;
    const bool coarse = had_coarse_room_ || coarse_.fits(counts_.coarse_pairs);
    const bool active = bin_.fits(counts_.active_clusters);
    // The need of each is known only once those before are complete.
    if (coarse && active && refine_.fits(counts_.refine_tests) && has_cuts_) {
        cut_->fits(cut_->entries());
    }
}

bool LightLists::is_binned(const GBuffer& gbuffer, const ClusterGrid& grid) const {
    return binned_version_ != 0 && binned_version_ == gbuffer.version &&
           std::memcmp(&grid, &binned_grid_, sizeof(grid)) == 0;
}

// The last active clusters where pixels and grid are the same, else new ones. `occupied`: see
// BinPixels.
ActiveClusters LightLists::active_of(const GBuffer& gbuffer, const ClusterGrid& grid,
                                     const DeviceArray<std::uint8_t>& occupied, StageTimer& timer) {
    if (is_binned(gbuffer, grid)) return active_;
    binned_version_ = 0;  // until they are complete
    active_ = {};         // arrays that grow must not be held twice
    active_ = bin_.enqueue(gbuffer, grid, timer, occupied);
    return active_;
}

ListedLights LightLists::refined(const CoarseLighting& coarse, const ActiveClusters& active,
                                 const GBuffer& gbuffer, StageTimer& timer) {
    RefinedLists lists = refine_.enqueue(coarse.lights, coarse.lists, active, gbuffer.view, timer);
    refine_room_ = lists.capacity;
    has_cuts_ = coarse.lights.node_count > 0;
    if (has_cuts_) {
        lists = cut_->enqueue({gbuffer, coarse.lights, active, bin_.total(), lists}, timer);
    }
    return {active.grid, coarse.lights, coarse.boxes, coarse.lists, active, lists, 0};
}

PixelLists LightLists::at_pixel(const ListedLights& lists, const View& view, uint x, uint y,
                                float z) const {
    const ClusterGrid& grid = lists.grid;
    PixelLists out;
    const uint column = picture_column(view, x) / grid.tile_width;
    const uint row = picture_row(view, y) / grid.tile_height;
    const uint coarse = cluster_index(grid, column, row, slice_of_depth(grid, z));
    const auto ends = download(gpu_, lists.coarse.offsets, 2, coarse);
    out.coarse_count = ends[1] - ends[0];
    const auto range = download(gpu_, lists.clusters.offsets, 2, fine_tile_of(view, x, y));
    for (const ActiveCluster& cluster :
         download(gpu_, lists.clusters.clusters, range[1] - range[0], range[0])) {
        if (cluster.slice != fine_slice_of_depth(grid, z)) continue;
        out.active = cluster;
        out.lights = download_indices(gpu_, lists.refined.lists, index_bits_, cluster.list_count,
                                      cluster.list_begin);
    }
    return out;
}

std::vector<ActiveCluster> LightLists::active_clusters(const ListedLights& lists) const {
    return download(gpu_, lists.clusters.clusters, counts_.active_clusters);
}

}  // namespace kilolux
