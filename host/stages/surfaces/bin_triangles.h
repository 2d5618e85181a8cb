// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"
#include "host/stages/lists/prefix_sum.h"

namespace kilolux {

StageWork bin_triangles_work(const StageCounts& counts);
inline constexpr StageInfo kBinTrianglesStage = {"bin_triangles", StageGroup::surfaces,
                                                 bin_triangles_work};

/// Sets up triangles and lists those that each tile's pixels may show. Like CullLights it works
/// with the room of the last call, and fits() says whether that was enough.
class BinTriangles {
 public:
    /// Words of a triangle's box of tiles.
    static constexpr std::size_t kBoxWords = 4;
    static constexpr std::size_t kTriangleBytes = sizeof(RasterRow) + kBoxWords * sizeof(uint);

    BinTriangles(const Gpu& gpu, const Tuning& tuning);

    /// The next enqueue() leaves tiles empty where `closed`, [tiles], is 1; empty: none.
    void close_tiles(std::span<const std::uint8_t> closed);

    /// Enqueues only. `triangle_count`: of all instances, at least 1 with any.
    TriangleLists enqueue(const SurfaceBuffers& scene, uint triangle_count, const View& view,
                          StageTimer& timer);

    /// Starts the copy that pairs() waits for. Enqueues only.
    void start_count(StageTimer& timer) { lists_.start_read(timer); }

    /// Pairs of triangle and tile of the last enqueue. Blocks.
    std::uint64_t pairs() const { return lists_.read_total(); }

    /// True if there is room for `pairs`; else makes room for the next enqueue. Throws Error where
    /// 32-bit offsets or the device cannot hold them.
    bool fits(std::uint64_t pairs) { return lists_.fits(pairs); }

 private:
    DeviceArray<uint> zero_counts(uint tiles);

    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel set_up_, offset_, fill_;
    GrowingArray<RasterRow> triangles_;
    GrowingArray<uint> boxes_, kept_, cursors_;
    GrowingArray<std::uint8_t> closed_;
    uint some_closed_ = 0;
    CountedList lists_;
    std::size_t zero_bytes_ = 0;  // of the buffer of zero_counts(), which grows; 0: unknown
};

}  // namespace kilolux
