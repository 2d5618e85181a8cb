// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/bin_triangles.h"

#include <algorithm>
#include <utility>

#include "kernels/shared/surface_scene.h"

namespace kilolux {
namespace {

constexpr std::size_t kFirstPairs = std::size_t{1} << 18;  // that there is room for from the start

// Work-items that share their triangles' tiles: many, so that many share large triangles. 1: each
// has its own chunk.
int bin_group(const Gpu& gpu, const Tuning& tuning) {
    return tuning.raster_group == 1 ? 1 : fitting_group(256, gpu.info);
}

// BINNING_ARGS of the kernels.
struct Binning {
    uint triangle_count, some_closed;
    DeviceArray<std::uint8_t> closed;
    DeviceArray<uint> boxes, kept, cursors;

    void each(auto&& set) const {
        set("triangle_count", triangle_count);
        set("some_closed", some_closed);
        set("closed", closed);
        set("boxes", boxes);
        set("kept", kept);
        set("cursors", cursors);
    }
};

BuildOptions bin_options(const Gpu& gpu, const Tuning& tuning) {
    BuildOptions options;
    options.define("GROUP", bin_group(gpu, tuning));
    define_tiles(options, tuning);
    return options;
}

}  // namespace

BinTriangles::BinTriangles(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kBinTrianglesStage, bin_options(gpu, tuning))),
      set_up_(gpu, program_, kBinTrianglesStage, "bin_triangles_set_up"),
      offset_(gpu, program_, kBinTrianglesStage, "bin_triangles_offset"),
      fill_(gpu, program_, kBinTrianglesStage, "bin_triangles_fill"),
      triangles_(gpu, kBinTrianglesStage),
      boxes_(gpu, kBinTrianglesStage),
      kept_(gpu, kBinTrianglesStage),
      cursors_(gpu, kBinTrianglesStage),
      closed_(gpu, kBinTrianglesStage),
      lists_(gpu, tuning, kBinTrianglesStage, "(triangle, tile) pairs", sizeof(uint)) {
    lists_.reserve(kFirstPairs);
    closed_.reserve(1);
}

void BinTriangles::close_tiles(std::span<const std::uint8_t> closed) {
    some_closed_ = closed.empty() ? 0u : 1u;
    if (!closed.empty()) upload<std::uint8_t>(gpu_, closed_.reserve(closed.size()), closed);
}

// The counters of tiles that work-groups share: 0 unless an enqueue() ended between its kernels.
DeviceArray<uint> BinTriangles::zero_counts(uint tiles) {
    const std::size_t zero_bytes = std::exchange(zero_bytes_, 0);  // until they are 0 again
    const DeviceArray<uint> counts = lists_.counts(tiles);
    const auto bytes = counts.buffer().getInfo<CL_MEM_SIZE>();
    if (bytes != zero_bytes) gpu_.queue.enqueueFillBuffer(counts.buffer(), 0u, 0, bytes);
    return counts;
}

TriangleLists BinTriangles::enqueue(const SurfaceBuffers& scene, uint triangle_count,
                                    const View& view, StageTimer& timer) {
    const int group = bin_group(gpu_, tuning_);
    const bool by_group = group > 1;
    TriangleLists out;
    out.tile_count = raster_tile_count(view, tuning_);
    const std::size_t stride = round_up(out.tile_count, offset_.lanes());
    const std::size_t chunks =
        by_group ? 1
                 : std::clamp<std::size_t>(triangle_count, 1,
                                           static_cast<std::size_t>(tuning_.cull_chunks));
    const std::size_t some = std::max<std::size_t>(triangle_count, 1);
    out.triangles = triangles_.reserve(some);
    const Binning binning{
        triangle_count,
        some_closed_,
        closed_.get(),
        boxes_.reserve(kBoxWords * some),
        kept_.reserve(chunks),
        by_group ? zero_counts(out.tile_count) : cursors_.reserve(chunks * stride)};
    // Kernels rely on the size: one that the device cannot run throws.
    const auto item_count = static_cast<std::size_t>(group);
    const WorkSize walk =
        by_group ? groups((some + item_count - 1) / item_count, group) : groups(chunks, 1);
    set_up_.enqueue(walk, timer, view, scene, out.triangles, binning);
    if (!by_group) {
        offset_.enqueue(offset_.vector_items(stride, tuning_.light_group), timer, out.tile_count,
                        static_cast<uint>(chunks), binning.cursors, lists_.counts(stride));
    }
    out.offsets = lists_.enqueue_offsets(out.tile_count, timer);
    out.lists = lists_.entries<uint>();
    out.capacity = lists_.capacity();
    fill_.enqueue(walk, timer, view, binning, out);
    if (by_group) zero_bytes_ = binning.cursors.buffer().getInfo<CL_MEM_SIZE>();
    return out;
}

// A triangle is three indices and about half a vertex: neighbours share theirs.
StageWork bin_triangles_work(const StageCounts& c) {
    constexpr double kTriangle = 3 * sizeof(uint) + 0.5 * 3 * sizeof(float);
    constexpr double kBox = BinTriangles::kBoxWords * sizeof(uint);
    return {.bytes_read = kTriangle * c.triangles + kBox * c.seen_triangles,
            .bytes_written =
                (sizeof(RasterRow) + kBox) * c.seen_triangles + sizeof(uint) * c.triangle_pairs,
            .launches = 3};  // CPUs have one more
}

}  // namespace kilolux
