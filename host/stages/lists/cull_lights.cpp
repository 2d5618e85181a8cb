// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/cull_lights.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kBruteForce = "cull_lights_brute_force";
// Initial room: enough for most scenes' first frame.
constexpr std::size_t kFirstCoarseEntries = std::size_t{1} << 20;

// BLOCK and SPAN of kernels/lists/cull_lights_by_group.cl.
constexpr std::size_t kLightsOfBlock = 32, kBlocksOfSpan = 64;
constexpr std::size_t kLightsOfSpan = kLightsOfBlock * kBlocksOfSpan;
// Work-groups then have even shares.
constexpr std::size_t kMostChunksOfCluster = 32;
// NVIDIA H100, a million lights: 8, 16, 32 take 0.90, 0.61, 0.56 ms.
constexpr std::size_t kGroupsOfUnit = 32;

std::size_t span_count(std::size_t lights) {
    return std::max<std::size_t>((lights + kLightsOfSpan - 1) / kLightsOfSpan, 1);
}

std::string_view program_name(const Tuning& tuning) {
    return tuning.cull_group == 1 ? "cull_lights_by_item" : "cull_lights_by_group";
}

// The form by groups has BLOCK_ITEMS items a block.
Tuning with_whole_blocks(Tuning tuning, const DeviceInfo& device) {
    if (device.max_work_group < 4) tuning.cull_group = 1;
    return tuning;
}

constexpr int kBlockGroup = 256;  // find the blocks of a span: few lights each, loaded at once

BuildOptions cull_options(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features) {
    return BuildOptions()
        .define("GROUP", tuning.cull_group)
        .define("BLOCK", kLightsOfBlock)
        .define("SPAN", kBlocksOfSpan)
        .define("BLOCK_GROUP", fitting_group(kBlockGroup, gpu.info))
        .define("HAS_SPOT_LIGHTS", features.spot_lights)
        .define("LIGHT_INDEX", light_index_type(features));
}

}  // namespace

CullLights::CullLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(with_whole_blocks(tuning, gpu.info)),
      groups_(kGroupsOfUnit * static_cast<std::size_t>(gpu.info.compute_units)),
      block_group_(fitting_group(kBlockGroup, gpu.info)),
      program_(build_program(gpu, program_name(tuning_), cull_options(gpu, tuning_, features))),
      count_(gpu, program_, kCullLightsStage, "cull_lights_count"),
      offset_(gpu, program_, kCullLightsStage, "cull_lights_offset"),
      fill_(gpu, program_, kCullLightsStage, "cull_lights_fill"),
      brute_force_(gpu, program_, kBruteForce, "cull_lights_brute_force"),
      cursors_(gpu, kCullLightsStage),
      lists_(gpu, tuning, kCullLightsStage, "(light, cluster) pairs", light_index_bytes(features)) {
    if (tuning_.cull_group > 1) blocks_.emplace(gpu, program_);
    lists_.reserve(kFirstCoarseEntries);
}

CullLights::Blocks::Blocks(const Gpu& gpu, const KernelProgram& program)
    : cull_blocks(gpu, program, kCullLightsStage, "cull_lights_blocks"),
      cull_clusters(gpu, program, kCullLightsStage, "cull_lights_clusters"),
      blocks(gpu, kCullLightsStage),
      spans(gpu, kCullLightsStage),
      work_count(gpu, kCullLightsStage),
      work(gpu, kCullLightsStage) {
    work_count.reserve(1);
}

std::size_t CullLights::chunk_count(std::size_t lights) const {
    if (blocks_) return std::min(span_count(lights), kMostChunksOfCluster);
    return std::clamp<std::size_t>(lights, 1, static_cast<std::size_t>(tuning_.cull_chunks));
}

// Of kernels/lists/cull_lights.h: as many vectors of lanes as hold a chunk's clusters.
std::size_t CullLights::cursor_stride(const ClusterGrid& grid) const {
    return round_up(grid.cluster_count, offset_.lanes());
}

CoarseLists CullLights::lists_so_far(const DeviceArray<uint>& offsets) const {
    return {offsets, lists_.entries<std::byte>(), lists_.capacity(), total()};
}

CoarseLists CullLights::sort_pairs(const ClusterGrid& grid, std::size_t chunks, StageTimer& timer,
                                   auto&& count, auto&& fill) {
    const std::size_t stride = cursor_stride(grid);
    const DeviceArray<uint> cursors = cursors_.reserve(chunks * stride);
    const DeviceArray<uint> counts = lists_.counts(stride);
    count(cursors);
    offset_.enqueue(offset_.vector_items(stride, tuning_.light_group), timer, grid.cluster_count,
                    static_cast<uint>(chunks), cursors, counts);
    CoarseLists out = lists_so_far(lists_.enqueue_offsets(grid.cluster_count, timer));
    fill(cursors, out);
    return out;
}

CoarseLists CullLights::enqueue(const PreparedLights& lights, const ClusterBoxes& boxes,
                                StageTimer& timer, const DeviceArray<std::uint8_t>& occupied) {
    const ClusterGrid& grid = boxes.grid;
    const std::size_t chunks = chunk_count(lights.count);
    if (!blocks_) {
        const WorkSize size = groups(chunks, 1);
        return sort_pairs(
            grid, chunks, timer,
            [&](const auto& cursors) {
                count_.enqueue(size, timer, lights, boxes, occupied, cursors);
            },
            [&](const auto& cursors, const CoarseLists& out) {
                fill_.enqueue(size, timer, lights, boxes, occupied, cursors, out);
            });
    }
    const std::size_t spans = span_count(lights.count);
    const auto chunks_of_cluster = static_cast<uint>(chunks);
    Blocks& by = *blocks_;
    by.cull_blocks.enqueue(groups(spans, block_group_), timer, lights,
                           by.blocks.reserve(spans * kBlocksOfSpan), by.spans.reserve(spans),
                           by.work_count.get());
    const DeviceArray<uint> work = by.work.reserve(grid.cluster_count);
    const WorkSize size = groups(groups_, tuning_.cull_group);
    return sort_pairs(
        grid, chunks, timer,
        [&](const auto& cursors) {
            by.cull_clusters.enqueue(items(grid.cluster_count, tuning_.light_group), timer,
                                     grid.cluster_count, chunks_of_cluster, occupied, cursors,
                                     by.work_count.get(), work);
            count_.enqueue(size, timer, lights, boxes, by, chunks_of_cluster, cursors);
        },
        [&](const auto& cursors, const CoarseLists& out) {
            fill_.enqueue(size, timer, lights, boxes, by, chunks_of_cluster, cursors, out);
        });
}

CoarseLists CullLights::brute_force(const PreparedLights& lights, const ClusterBoxes& boxes,
                                    StageTimer& timer) {
    const ClusterGrid& grid = boxes.grid;
    const DeviceArray<uint> counts = lists_.counts(cursor_stride(grid));
    const auto run = [&](uint fill, const CoarseLists& out) {
        brute_force_.enqueue(items(grid.cluster_count, tuning_.light_group), timer, lights, boxes,
                             fill, counts, out);
    };
    run(0, {});
    const DeviceArray<uint> offsets = lists_.enqueue_offsets(grid.cluster_count, timer);
    fits();
    CoarseLists out = lists_so_far(offsets);
    run(1, out);
    return out;
}

// Of the form by_item: counting and filling read the lights once each; then a cursor, an offset and
// a total a cluster. StageCounts do not tell the form. by_group has two launches more, and reads
// the extents of spans, and the blocks and lights of those that reach it, for each cluster.
StageWork cull_lights_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.clusters);
    const double light =
        kRowBytes + sizeof(LightExtent) + (c.kernels.spot_lights ? sizeof(ShadeLight) : 0.0);
    work.bytes_read += 2.0 * light * c.lights + 3.0 * kWordBytes * c.clusters;
    work.bytes_written += 3.0 * kWordBytes * c.clusters + c.index_bytes() * c.coarse_pairs;
    work.launches += 3;
    return work;
}

}  // namespace kilolux
