// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/bin_triangles.h"

#include <algorithm>
#include "kernels/shared/raster_row.h"

namespace kilolux {
namespace {

constexpr std::size_t kFirstPairs = std::size_t{1} << 18;  // that there is room for from the start
constexpr std::size_t kBoxWords = 4;                       // of a triangle's box of tiles

// Work-items that share their triangles' tiles: many, so that large triangles are shared by many.
// 1: each has a chunk of its own.
int bin_group(const Tuning& tuning) { return tuning.raster_group == 1 ? 1 : 256; }

BuildOptions bin_options(const Tuning& tuning) {
    BuildOptions options;
    options.define("GROUP", bin_group(tuning));
    define_tiles(options, tuning);
    return options;
}

}  // namespace

BinTriangles::BinTriangles(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kBinTrianglesStage, bin_options(tuning))),
      clear_(gpu, program_, kBinTrianglesStage, "bin_triangles_clear"),
      set_up_(gpu, program_, kBinTrianglesStage, "bin_triangles_set_up"),
      offset_(gpu, program_, kBinTrianglesStage, "bin_triangles_offset"),
      fill_(gpu, program_, kBinTrianglesStage, "bin_triangles_fill"),
      triangles_(gpu, kBinTrianglesStage),
      boxes_(gpu, kBinTrianglesStage),
      kept_(gpu, kBinTrianglesStage),
      cursors_(gpu, kBinTrianglesStage),
      closed_(gpu, kBinTrianglesStage),
      lists_(gpu, tuning, kBinTrianglesStage, sizeof(uint)) {
    lists_.reserve(kFirstPairs);
    closed_.reserve(1);
}

void BinTriangles::close_tiles(std::span<const std::uint8_t> closed) {
    some_closed_ = closed.empty() ? 0u : 1u;
    if (!closed.empty()) upload<std::uint8_t>(gpu_, closed_.reserve(closed.size()), closed);
}

TriangleLists BinTriangles::enqueue(const SurfaceBuffers& scene, uint triangle_count,
                                    const View& view, StageTimer& timer) {
    const auto lanes = static_cast<std::size_t>(gpu_.info.lane_width);
    const int group = bin_group(tuning_);
    const bool by_group = group > 1;
    TriangleLists out;
    out.tile_count = raster_tile_count(view, tuning_);
    const std::size_t stride = round_up(out.tile_count, lanes);
    const std::size_t chunks =
        by_group ? 1
                 : std::clamp<std::size_t>(triangle_count, 1,
                                           static_cast<std::size_t>(tuning_.cull_chunks));
    const std::size_t some = std::max<std::size_t>(triangle_count, 1);
    out.triangles = triangles_.reserve(some);
    const DeviceArray<uint> boxes = boxes_.reserve(kBoxWords * some);
    const DeviceArray<uint> kept = kept_.reserve(chunks);
    const DeviceArray<uint> cursors = cursors_.reserve(chunks * stride);
    const DeviceArray<uint> counts = lists_.counts(stride);
    const WorkSize walk = by_group ? items(some, group) : groups(chunks, 1);
    if (by_group) {
        clear_.enqueue(items(stride, group), timer, static_cast<uint>(stride), cursors);
    }
    set_up_.enqueue(walk, timer, view, scene.instances, scene.instance_blocks, scene.meshes,
                    scene.vertices, scene.indices, scene.materials, triangle_count, some_closed_,
                    closed_.get(), out.triangles, boxes, kept, cursors);
    offset_.enqueue(items(stride / lanes, tuning_.light_group), timer, out.tile_count,
                    static_cast<uint>(chunks), cursors, counts);
    out.offsets = lists_.enqueue_offsets(out.tile_count, timer);
    out.lists = lists_.entries<uint>();
    out.capacity = lists_.capacity();
    fill_.enqueue(walk, timer, view, triangle_count, some_closed_, closed_.get(), out.triangles,
                  boxes, kept, cursors, out.offsets, out.lists, out.capacity);
    return out;
}

// A triangle is three indices and about half a vertex: neighbours share theirs.
StageWork bin_triangles_work(const StageCounts& c) {
    constexpr double kTriangle = 3 * sizeof(uint) + 0.5 * 3 * sizeof(float);
    constexpr double kBox = kBoxWords * sizeof(uint);
    return {.bytes_read = kTriangle * c.triangles + kBox * c.seen_triangles,
            .bytes_written =
                (sizeof(RasterRow) + kBox) * c.seen_triangles + sizeof(uint) * c.triangle_pairs,
            .launches = 4};
}

}  // namespace kilolux
