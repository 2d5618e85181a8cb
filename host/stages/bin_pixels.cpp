// SPDX-License-Identifier: Apache-2.0
#include "host/stages/bin_pixels.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kStage = "bin_pixels";

}  // namespace

BinPixels::BinPixels(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kStage,
                             BuildOptions()
                                 .define("GROUP", tuning.tile_group)
                                 .define("GBUFFER", static_cast<int>(features.gbuffer)))),
      prefix_sum_(gpu, tuning),
      counts_(gpu, kStage),
      offsets_(gpu, kStage),
      clusters_(gpu, kStage),
      order_(gpu, kStage),
      occupied_(gpu, kStage) {}

cl::Buffer BinPixels::cleared_occupied(const ClusterGrid& grid, StageTimer& timer) {
    const cl::Buffer& occupied = occupied_.reserve(grid.cluster_count);
    const auto group = static_cast<std::size_t>(tuning_.light_group);
    cl::KernelFunctor<uint, cl::Buffer> clear(program_, "bin_pixels_clear");
    timer.record(kStage,
                 clear(cl::EnqueueArgs(gpu_.queue, cl::NDRange(round_up(grid.cluster_count, group)),
                                       cl::NDRange(group)),
                       grid.cluster_count, occupied));
    return occupied;
}

ActiveClusters BinPixels::enqueue(const GBuffer& gbuffer, const ClusterGrid& grid,
                                  StageTimer& timer) {
    return in_stage(kStage, [&] {
        const View& view = gbuffer.view;
        ActiveClusters out;
        out.tile_count = ((view.width + FINE_TILE - 1) / FINE_TILE) *
                         ((view.height + FINE_TILE - 1) / FINE_TILE);
        out.offsets = offsets_.reserve((out.tile_count + std::size_t{1}) * sizeof(uint));
        // Most tiles have one or two.
        if (clusters_.bytes() == 0)
            clusters_.reserve(std::size_t{2} * out.tile_count * sizeof(ActiveCluster));
        out.clusters = clusters_.get();
        out.capacity = static_cast<uint>(clusters_.bytes() / sizeof(ActiveCluster));
        out.order = order_.reserve(std::size_t{FINE_TILE} * FINE_TILE * out.tile_count);
        const cl::Buffer& counts = counts_.reserve(out.tile_count * sizeof(uint));
        const auto group = static_cast<std::size_t>(tuning_.tile_group);
        const cl::EnqueueArgs items(gpu_.queue, cl::NDRange(out.tile_count * group),
                                    cl::NDRange(group));
        out.occupied = cleared_occupied(grid, timer);
        cl::KernelFunctor<cl::Buffer, GBufferLayout, View, ClusterGrid, cl::Buffer, cl::Buffer>
            count(program_, "bin_pixels_count");
        timer.record(kStage,
                     count(items, gbuffer.bytes, gbuffer.layout, view, grid, counts, out.occupied));
        prefix_sum_.enqueue(counts, out.tile_count, out.offsets, timer, kStage);
        cl::KernelFunctor<cl::Buffer, GBufferLayout, View, ClusterGrid, cl::Buffer, cl::Buffer,
                          uint, cl::Buffer>
            fill(program_, "bin_pixels_fill");
        timer.record(kStage, fill(items, gbuffer.bytes, gbuffer.layout, view, grid, out.offsets,
                                  out.clusters, out.capacity, out.order));
        return out;
    });
}

bool BinPixels::fits() {
    const std::uint64_t needed = checked_list_size(active(), kStage) * sizeof(ActiveCluster);
    if (needed <= clusters_.bytes()) return true;
    clusters_.reserve(needed + needed / 8);
    return false;
}

}  // namespace kilolux
