// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/cull_lights.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kBruteForce = "cull_lights_brute_force";
// Initial room: enough for most scenes' first frame.
constexpr std::size_t kFirstCoarseEntries = std::size_t{1} << 20;

// BLOCK, SPAN and SEGMENTS of kernels/lists/cull_lights_by_group.cl.
constexpr std::size_t kLightsOfBlock = 32, kBlocksOfSpan = 64, kMostSegments = 1024;
constexpr std::size_t kLightsOfSpan = kLightsOfBlock * kBlocksOfSpan;
// NVIDIA H100, a million lights, by chunks in place of tasks: 8, 16, 32 take 0.90, 0.61, 0.56 ms.
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

// Work-items that join a span's extents: few each, loaded at once.
constexpr int kBlockGroup = 256;

BuildOptions cull_options(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features) {
    return BuildOptions()
        .define("GROUP", tuning.cull_group)
        .define("BLOCK", kLightsOfBlock)
        .define("SPAN", kBlocksOfSpan)
        .define("SEGMENTS", kMostSegments)
        .define("BLOCK_GROUP", fitting_group(kBlockGroup, gpu.info))
        .define("HAS_SPOT_LIGHTS", features.spot_lights)
        .define("LIGHT_INDEX", light_index_type(features));
}

}  // namespace

CullLights::CullLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                       std::size_t most_tasks)
    : tuning_(with_whole_blocks(tuning, gpu.info)),
      most_tasks_(most_tasks),
      groups_(kGroupsOfUnit * static_cast<std::size_t>(gpu.info.compute_units)),
      block_group_(fitting_group(kBlockGroup, gpu.info)),
      program_(build_program(gpu, program_name(tuning_), cull_options(gpu, tuning_, features))),
      count_(gpu, program_, kCullLightsStage, "cull_lights_count"),
      starts_(gpu, program_, kCullLightsStage,
              tuning_.cull_group == 1 ? "cull_lights_offset" : "cull_lights_starts"),
      fill_(gpu, program_, kCullLightsStage, "cull_lights_fill"),
      brute_force_(gpu, program_, kBruteForce, "cull_lights_brute_force"),
      cursors_(gpu, kCullLightsStage),
      lists_(gpu, tuning, kCullLightsStage, "(light, cluster) pairs", light_index_bytes(features)) {
    if (tuning_.cull_group > 1) by_group_.emplace(gpu, program_);
    lists_.reserve(kFirstCoarseEntries);
}

CullLights::ByGroup::ByGroup(const Gpu& gpu, const KernelProgram& program)
    : cull_blocks(gpu, program, kCullLightsStage, "cull_lights_blocks"),
      cull_tasks(gpu, program, kCullLightsStage, "cull_lights_tasks"),
      blocks(gpu, kCullLightsStage),
      spans(gpu, kCullLightsStage),
      task_count(gpu, kCullLightsStage),
      tasks(gpu, kCullLightsStage),
      cluster_tasks(gpu, kCullLightsStage),
      task_lights(gpu, kCullLightsStage),
      task_starts(gpu, kCullLightsStage) {
    task_count.reserve(1);
}

// Of kernels/device/chunk_starts.h: as many vectors of lanes as hold a chunk's clusters.
std::size_t CullLights::cursor_stride(const ClusterGrid& grid) const {
    return round_up(grid.cluster_count, starts_.lanes());
}

// A segment is one span, unless those are more than kMostSegments or need more than most_tasks_.
std::size_t CullLights::segment_count(std::size_t lights, const ClusterGrid& grid) const {
    const std::size_t most = most_tasks_ / std::max<std::size_t>(grid.cluster_count, 1);
    return std::min(span_count(lights), std::clamp<std::size_t>(most, 1, kMostSegments));
}

CoarseLists CullLights::lists_so_far(const DeviceArray<uint>& offsets) const {
    return {offsets, lists_.entries<std::byte>(), lists_.capacity(), total()};
}

CoarseLists CullLights::enqueue(const PreparedLights& lights, const ClusterBoxes& boxes,
                                StageTimer& timer, const DeviceArray<std::uint8_t>& occupied) {
    return by_group_ ? enqueue_by_group(lights, boxes, timer, occupied)
                     : enqueue_by_item(lights, boxes, timer, occupied);
}

CoarseLists CullLights::enqueue_by_item(const PreparedLights& lights, const ClusterBoxes& boxes,
                                        StageTimer& timer,
                                        const DeviceArray<std::uint8_t>& occupied) {
    const ClusterGrid& grid = boxes.grid;
    const auto chunks =
        std::clamp<std::size_t>(lights.count, 1, static_cast<std::size_t>(tuning_.cull_chunks));
    const WorkSize size = groups(chunks, 1);
    const std::size_t stride = cursor_stride(grid);
    const DeviceArray<uint> cursors = cursors_.reserve(chunks * stride);
    count_.enqueue(size, timer, lights, boxes, occupied, cursors);
    starts_.enqueue(starts_.vector_items(stride, tuning_.light_group), timer, grid.cluster_count,
                    static_cast<uint>(chunks), cursors, lists_.counts(stride));
    const CoarseLists out = lists_so_far(lists_.enqueue_offsets(grid.cluster_count, timer));
    fill_.enqueue(size, timer, lights, boxes, occupied, cursors, out);
    return out;
}

CoarseLists CullLights::enqueue_by_group(const PreparedLights& lights, const ClusterBoxes& boxes,
                                         StageTimer& timer,
                                         const DeviceArray<std::uint8_t>& occupied) {
    const ClusterGrid& grid = boxes.grid;
    const std::size_t spans = span_count(lights.count);
    ByGroup& by = *by_group_;
    by.segment_count = static_cast<uint>(segment_count(lights.count, grid));
    const std::size_t clusters = grid.cluster_count, room = by.segment_count * clusters;
    by.cull_blocks.enqueue(groups(spans, block_group_), timer, lights,
                           by.blocks.reserve(spans * kBlocksOfSpan), by.spans.reserve(spans),
                           by.task_count.get());
    const DeviceArray<uint> cluster_tasks = by.cluster_tasks.reserve(2 * clusters);
    by.tasks.reserve(room);
    by.cull_tasks.enqueue(groups(clusters, tuning_.cull_group), timer, lights.count, boxes,
                          occupied, by, cluster_tasks);
    const WorkSize size = groups(groups_, tuning_.cull_group);
    const DeviceArray<uint> task_lights = by.task_lights.reserve(room),
                            task_starts = by.task_starts.reserve(room);
    count_.enqueue(size, timer, lights, boxes, by, task_lights);
    starts_.enqueue(items(grid.cluster_count, tuning_.light_group), timer, grid.cluster_count,
                    cluster_tasks, task_lights, task_starts, lists_.counts(grid.cluster_count));
    const CoarseLists out = lists_so_far(lists_.enqueue_offsets(grid.cluster_count, timer));
    fill_.enqueue(size, timer, lights, boxes, by, task_starts, out);
    return out;
}

CoarseLists CullLights::brute_force(const PreparedLights& lights, const ClusterBoxes& boxes,
                                    StageTimer& timer) {
    const ClusterGrid& grid = boxes.grid;
    const DeviceArray<uint> counts = lists_.counts(grid.cluster_count);
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
