// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/bin_pixels.h"

#include <algorithm>
#include "host/base/formats/gbuffer_layout.h"

namespace kilolux {
namespace {

KernelProgram bin_program(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features) {
    return build_program(gpu, tuning.tile_group == 1 ? "bin_pixels_by_item" : "bin_pixels_by_group",
                         BuildOptions()
                             .define("GROUP", tuning.tile_group)
                             .define("GBUFFER", static_cast<int>(features.gbuffer)));
}

constexpr std::size_t kFewest = 1024;  // active clusters that there is room for from the start

}  // namespace

BinPixels::BinPixels(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      program_(bin_program(gpu, tuning, features)),
      clear_(gpu, program_, kBinPixelsStage, "bin_pixels_clear"),
      count_(gpu, program_, kBinPixelsStage, "bin_pixels_count"),
      fill_(gpu, program_, kBinPixelsStage, "bin_pixels_fill"),
      clusters_(gpu, tuning, kBinPixelsStage, "active clusters", sizeof(ActiveCluster)),
      order_(gpu, kBinPixelsStage),
      occupied_(gpu, kBinPixelsStage) {}

ActiveClusters BinPixels::enqueue(const GBuffer& gbuffer, const ClusterGrid& grid,
                                  StageTimer& timer, const DeviceArray<std::uint8_t>& occupied) {
    const View& view = gbuffer.view;
    ActiveClusters out;
    out.grid = grid;
    out.tile_count = fine_tile_count(view);
    // Most tiles have one or two; a small picture's may all have many.
    if (clusters_.capacity() == 0) {
        clusters_.reserve(std::max<std::size_t>(std::size_t{2} * out.tile_count, kFewest));
    }
    out.clusters = clusters_.entries<ActiveCluster>();
    out.capacity = clusters_.capacity();
    out.order = order_.reserve(std::size_t{FINE_TILE_PIXELS} * out.tile_count);
    const bool alone = occupied.buffer()() == nullptr;
    out.occupied = alone ? occupied_.reserve(grid.cluster_count) : occupied;
    const DeviceArray<uint> counts = clusters_.counts(out.tile_count);
    const WorkSize tiles = groups(out.tile_count, tuning_.tile_group);
    if (alone) {
        clear_.enqueue(items(grid.cluster_count, tuning_.light_group), timer, grid.cluster_count,
                       out.occupied);
    }
    count_.enqueue(tiles, timer, gbuffer, grid, counts, out.occupied);
    out.offsets = clusters_.enqueue_offsets(out.tile_count, timer);
    fill_.enqueue(tiles, timer, gbuffer, out);
    return out;
}

StageWork bin_pixels_work(const StageCounts& c) {
    // Of a stored position; 0 where it follows from the depth.
    const double position = 3.0 * plane_element_bytes(c.kernels.gbuffer, PLANE_POSITION_X) +
                            plane_element_bytes(c.kernels.gbuffer, PLANE_ROW_0);
    StageWork work = prefix_sum_work(c.tiles);
    work.bytes_read += 4.0 * c.pixels + (4.0 + position) * c.surface_pixels;
    work.bytes_written += kWordBytes * c.tiles + sizeof(ActiveCluster) * c.active_clusters +
                          kPixelOrderBytes * c.pixels;
    work.launches += 3;
    return work;
}

}  // namespace kilolux
