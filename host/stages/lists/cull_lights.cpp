// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/cull_lights.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kBruteForce = "cull_lights_brute_force";
// Initial room: enough for most scenes' first frame.
constexpr std::size_t kFirstCoarseEntries = std::size_t{1} << 20;

// A chunk of more lights is divided into more chunks.
constexpr std::size_t kLightsOfChunk = 256;

std::size_t chunk_count(std::size_t lights, const Tuning& tuning) {
    const auto usual = static_cast<std::size_t>(tuning.cull_chunks);
    const auto most = static_cast<std::size_t>(std::max(tuning.most_cull_chunks, 0));
    const std::size_t wanted = std::max(usual, std::min(most, lights / kLightsOfChunk));
    return std::clamp<std::size_t>(lights, 1, wanted);
}

BuildOptions cull_options(const KernelFeatures& features) {
    return BuildOptions()
        .define("HAS_SPOT_LIGHTS", features.spot_lights)
        .define("LIGHT_INDEX", light_index_type(features));
}

}  // namespace

CullLights::CullLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      program_(build_program(gpu, kCullLightsStage, cull_options(features))),
      count_(gpu, program_, kCullLightsStage, "cull_lights_count"),
      offset_(gpu, program_, kCullLightsStage, "cull_lights_offset"),
      fill_(gpu, program_, kCullLightsStage, "cull_lights_fill"),
      brute_force_(gpu, program_, kBruteForce, "cull_lights_brute_force"),
      cursors_(gpu, kCullLightsStage),
      lists_(gpu, tuning, kCullLightsStage, "(light, cluster) pairs", light_index_bytes(features)) {
    lists_.reserve(kFirstCoarseEntries);
}

// Of kernels/lists/cull_lights.cl: as many vectors of lanes as hold a chunk's clusters.
std::size_t CullLights::cursor_stride(const ClusterGrid& grid) const {
    return round_up(grid.cluster_count, offset_.lanes());
}

CoarseLists CullLights::lists_so_far(const DeviceArray<uint>& offsets) const {
    return {offsets, lists_.entries<std::byte>(), lists_.capacity(), total()};
}

CoarseLists CullLights::enqueue(const PreparedLights& lights, const ClusterBoxes& boxes,
                                StageTimer& timer, const DeviceArray<std::uint8_t>& occupied) {
    const ClusterGrid& grid = boxes.grid;
    const std::size_t chunks = chunk_count(lights.count, tuning_);
    const std::size_t stride = cursor_stride(grid);
    const DeviceArray<uint> cursors = cursors_.reserve(chunks * stride);
    const DeviceArray<uint> counts = lists_.counts(stride);
    const WorkSize size = groups(chunks, tuning_.cull_group);
    count_.enqueue(size, timer, lights, boxes, occupied, cursors);
    offset_.enqueue(offset_.vector_items(stride, tuning_.light_group), timer, grid.cluster_count,
                    static_cast<uint>(chunks), cursors, counts);
    CoarseLists out = lists_so_far(lists_.enqueue_offsets(grid.cluster_count, timer));
    fill_.enqueue(size, timer, lights, boxes, occupied, cursors, out);
    return out;
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

// Counting and filling read the lights once each; then a cursor, an offset and a total a cluster.
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
