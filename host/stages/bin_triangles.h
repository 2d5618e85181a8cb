// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/stages/prefix_sum.h"
#include "host/stages/resolve_surfaces.h"

namespace kilolux {

/// Triangles of each tile of the picture: lists[offsets[t] .. offsets[t + 1]), numbers along the
/// instances.
struct TriangleLists {
    DeviceArray<uint> offsets;  // [tile_count + 1]
    DeviceArray<uint> lists;    // [capacity]
    uint capacity = 0;
    uint tile_count = 0;
};

/// Lists the triangles that each tile's pixels may show. As CullLights, it works with the room of
/// the last call, and fits() says whether that was enough.
class BinTriangles {
 public:
    BinTriangles(const Gpu& gpu, const Tuning& tuning);

    /// Enqueues only. `triangle_count`: of all instances, at least 1 with any.
    TriangleLists enqueue(const SurfaceBuffers& scene, uint triangle_count, const View& view,
                          StageTimer& timer);

    /// Pairs of triangle and tile of the last enqueue. Blocks.
    std::uint64_t pairs() const { return lists_.read_total(); }

    /// True if there is room for `pairs`; else makes room for the next enqueue. Throws Error where
    /// 32-bit offsets or the device cannot hold them.
    bool fits(std::uint64_t pairs) { return lists_.fits(pairs); }

 private:
    Gpu gpu_;
    Tuning tuning_;
    cl::Program program_;
    Kernel bounds_, clear_, count_, offset_, fill_;
    GrowingArray<uint> columns_, rows_, cursors_;
    CountedList lists_;
};

/// What of the tiles is compiled into bin_triangles and raster_triangles.
void define_tiles(BuildOptions& options, const Tuning& tuning);

/// Tiles of a view.
uint raster_tile_count(const View& view, const Tuning& tuning);

}  // namespace kilolux
