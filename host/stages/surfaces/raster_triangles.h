// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

StageWork raster_triangles_work(const StageCounts& counts);
inline constexpr StageInfo kRasterTrianglesStage = {"raster_triangles", StageGroup::surfaces,
                                                    raster_triangles_work};

/// Draws tiles' triangles as triangle ids.
class RasterTriangles {
 public:
    static constexpr std::size_t kPixelBytes = sizeof(uint);  // an id

    RasterTriangles(const Gpu& gpu, const Tuning& tuning, const SurfaceFeatures& features);

    /// ids[view.height][view.stride]: 0 for background, else 1 + the triangle's number along the
    /// instances; undefined past the width. Enqueues only; valid until the next call.
    DeviceArray<uint> enqueue(const SurfaceBuffers& scene, const TriangleLists& lists,
                              const View& view, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<uint> ids_;
};

}  // namespace kilolux
