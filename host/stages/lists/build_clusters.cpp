// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/build_clusters.h"

#include <algorithm>
#include <bit>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Edge in pixels, a multiple of FINE_TILE, of about size / tiles.
uint tile_edge(uint size, uint tiles) {
    const uint wanted = (size + std::max(tiles, 1u) - 1) / std::max(tiles, 1u);
    return std::max((wanted + FINE_TILE - 1) / FINE_TILE * FINE_TILE, uint{FINE_TILE});
}

// LightExtent has 16 bits for a tile's column, row and slice; kernels number clusters in 32.
uint checked_cluster_count(const ClusterGrid& grid) {
    constexpr uint kMostTiles = 0xffffu;
    constexpr std::uint64_t kMostClusters = 0xfffffff0u;
    const std::uint64_t count = std::uint64_t{grid.tiles_x} * grid.tiles_y;
    const uint most = std::max({grid.tiles_x, grid.tiles_y, grid.slices});
    if (most <= kMostTiles && count <= kMostClusters / grid.slices)
        return static_cast<uint>(count * grid.slices);
    throw Error(std::string(kBuildClustersStage) + ": a grid of " + std::to_string(grid.tiles_x) +
                " x " + std::to_string(grid.tiles_y) + " tiles and " + std::to_string(grid.slices) +
                " slices; there can be " + std::to_string(kMostTiles) + " a side and " +
                std::to_string(kMostClusters) + " clusters");
}

}  // namespace

ClusterGrid make_cluster_grid(const GridRequest& request, uint width, uint height) {
    ClusterGrid grid{};
    grid.tile_width = tile_edge(width, request.tiles_x);
    grid.tile_height = tile_edge(height, request.tiles_y);
    grid.tiles_x = (width + grid.tile_width - 1) / grid.tile_width;
    grid.tiles_y = (height + grid.tile_height - 1) / grid.tile_height;
    grid.slices_per_octave = std::clamp(request.slices_per_octave, 1u, 64u);
    const uint fine = std::clamp(request.fine_per_octave, grid.slices_per_octave, 64u);
    grid.fine_slice_bits = static_cast<uint>(std::bit_width(fine / grid.slices_per_octave)) - 1u;
    // 2^-100: far from denormals, which devices may flush.
    const float first = std::clamp(request.z_first, 0x1p-100f, 0x1p100f);
    const float last = std::clamp(request.z_last, first, 0x1p100f);
    grid.z_first_bits = std::bit_cast<uint>(first);
    grid.slices = ~0u;  // while the last slice's number is computed
    grid.slices = slice_of_depth(grid, last) + 1u;
    grid.cluster_count = checked_cluster_count(grid);
    grid.position_pad = request.position_pad;
    return grid;
}

BuildClusters::BuildClusters(const Gpu& gpu)
    : kernel_(gpu, build_program(gpu, kBuildClustersStage), kBuildClustersStage, "build_clusters"),
      columns_(gpu, kBuildClustersStage),
      rows_(gpu, kBuildClustersStage),
      depths_(gpu, kBuildClustersStage) {}

ClusterBoxes BuildClusters::enqueue(const View& view, const ClusterGrid& grid, StageTimer& timer) {
    const std::size_t slices = grid.slices;
    ClusterBoxes out{grid, columns_.reserve(slices * grid.tiles_x),
                     rows_.reserve(slices * grid.tiles_y), depths_.reserve(slices)};
    const WorkSize size{cl::NDRange(std::max(grid.tiles_x, grid.tiles_y), slices),
                        cl::NDRange(1, 1)};
    kernel_.enqueue(size, timer, view, out);
    return out;
}

StageWork build_clusters_work(const StageCounts& c) {
    return {.bytes_written = c.box_intervals * 2.0 * sizeof(float), .launches = 1};
}

}  // namespace kilolux
