// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/cast_shadows.h"

#include <algorithm>
#include <utility>

namespace kilolux {
namespace {

// Work-groups for each tile; they share its lights. More groups shorten the tiles that end last,
// but each group loads the tile's points: so there are 16 only where tiles have more than kLongList
// lights on average, and never for sampled shadows, which have few rays. words: of all tiles, maybe
// of the frame before; a light that reaches a whole tile has 8.
std::size_t groups_of_tile(bool is_sampled, std::uint64_t words, uint tiles) {
    constexpr std::uint64_t kLongList = 32;  // lights
    const bool is_long = words > std::uint64_t{tiles} * kLongList * (FINE_TILE_PIXELS / 32);
    return is_long && !is_sampled ? 16 : 8;
}

constexpr std::size_t kFirstWords = std::size_t{1} << 18;  // that there is room for from the start

// In the work-group form PoCL 3.1 loses values across barriers and reads through wild pointers;
// oclgrind finds no fault in it. A CPU would not gain by it.
Tuning usable_for_shadows(Tuning tuning, const DeviceInfo& device) {
    if ((device.is_cpu || device.is_pocl()) && !device.is_oclgrind()) {
        tuning.shadow_group = std::min(tuning.shadow_group, 1);
    }
    return tuning;
}

KernelProgram cast_program(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                           const SurfaceFeatures& surfaces, bool counts) {
    BuildOptions options = feature_options(features);
    define_casters(options, surfaces, tuning);
    options.define("PICKED_ONLY", features.sampled_shadows).define("COUNT_SHADOWS", counts);
    if (tuning.shadow_group == 0) return build_program(gpu, "cast_shadows_by_bundle", options);
    if (tuning.shadow_group == 1) return build_program(gpu, "cast_shadows_by_item", options);
    options.define("GROUP", tuning.shadow_group);
    return build_program(gpu.with_lanes(1), "cast_shadows_by_group", options);
}

}  // namespace

CastShadows::CastShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                         const SurfaceFeatures& surfaces, bool counts)
    : gpu_(gpu),
      tuning_(usable_for_shadows(tuning, gpu.info)),
      is_sampled_(features.sampled_shadows),
      has_counts_(counts),
      program_(cast_program(gpu, tuning_, features, surfaces, counts)),
      reserve_(gpu, program_, kCastShadowsStage, "cast_shadows_reserve"),
      cast_(gpu, program_, kCastShadowsStage, "cast_shadows"),
      words_(gpu, tuning, kCastShadowsStage, "words of shadow bits", sizeof(uint)),
      counts_(gpu, kCastShadowsStage) {
    if (tuning_.shadow_group > 1) order_.emplace(gpu, tuning, kCastShadowsStage);
    words_.reserve(kFirstWords);
}

ShadowWords CastShadows::reserve(const PreparedLights& lights, const ActiveClusters& clusters,
                                 StageTimer& timer, uint slots) {
    const uint tiles = clusters.tile_count;
    reserve_.enqueue(items(tiles, tuning_.light_group), timer, tiles, lights.directional_count,
                     slots, clusters, words_.counts(tiles));
    const DeviceArray<uint> offsets = words_.enqueue_offsets(tiles, timer);
    is_counted_ = !std::exchange(may_skip_wait_, false);
    if (is_counted_) {
        word_count_ = words_.read_total();
        words_.fits(word_count_);
    } else {
        words_.start_read(timer);
    }
    return {offsets, words_.capacity(), words_.entries<uint>()};
}

bool CastShadows::fits() {
    if (!std::exchange(is_counted_, true)) word_count_ = words_.read_total();
    may_skip_wait_ = word_count_ <= words_.capacity();
    return may_skip_wait_;
}

// The work size of the kernel that casts.
WorkSize CastShadows::work_size(uint tiles, const View& view) const {
    const int group = tuning_.shadow_group;
    if (group == 0) return cast_.pixel_items(view, tuning_.shade_rows);
    const std::size_t split = group > 1 ? groups_of_tile(is_sampled_, word_count_, tiles) : 1;
    return groups(tiles * split, group);  // exactly: the kernel finds `split` by it
}

void CastShadows::enqueue(const ShadowInput& input, const LitPixels& lit, const ShadowTargets& to,
                          StageTimer& timer, const ShadowSamples& samples) {
    const WorkSize size = work_size(lit.clusters.tile_count, lit.gbuffer.view);
    DeviceArray<ShadowCounts> counts;
    if (has_counts_) {
        const std::size_t items =
            size.global[0] * (size.global.dimensions() > 1 ? size.global[1] : 1);
        counts = counts_.reserve(items);
        gpu_.queue.enqueueFillBuffer(counts.buffer(), cl_uint{0}, 0, items * sizeof(ShadowCounts));
    }
    if (!order_) return cast_.enqueue(size, timer, lit, input, to, samples, counts);
    const DeviceArray<uint> tiles =
        order_->enqueue(to.words.offsets, lit.clusters.tile_count, timer);
    cast_.enqueue(size, timer, lit, input, to, samples, counts, tiles);
}

ShadowCounts CastShadows::counts() const {
    ShadowCounts sum{};
    for (const ShadowCounts& c : download(gpu_, counts_.get())) sum = sum + c;
    return sum;
}

// Nodes and triangles come from near caches.
StageWork cast_shadows_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.tiles);
    work.bytes_read += (kRowBytes + kPixelOrderBytes) * c.surface_pixels +
                       sizeof(ActiveCluster) * c.active_clusters +
                       c.index_bytes() * c.refined_pairs + kRowBytes * c.lights;
    work.bytes_written += kWordBytes * c.shadow_words;
    work.launches += 2;  // groups have one more: order_tiles
    work.evaluations = c.shadow_rays;
    return work;
}

}  // namespace kilolux
