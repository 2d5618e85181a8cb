// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

inline constexpr StageInfo kRasterLayersStage = {"raster_layers", StageGroup::surfaces};

/// Draws surfaces that blend over others as triangle ids, layer by layer from far to near.
class RasterLayers {
 public:
    static constexpr std::size_t kPixelBytes = sizeof(float) + sizeof(uint);  // a key and an id

    RasterLayers(const Gpu& gpu, const Tuning& tuning);

    /// Starts anew: the next enqueue() draws the farthest layer in front of `opaque`. Enqueues
    /// only.
    void begin(const GBuffer& opaque, StageTimer& timer);

    /// ids[view.height][view.stride] of the next layer, as RasterTriangles has them. `lists`: of
    /// the triangles of `scene`'s instances that blend. Enqueues only; valid until the next call.
    DeviceArray<uint> enqueue(const SurfaceBuffers& scene, const TriangleLists& lists,
                              StageTimer& timer);

    /// The last layer.
    struct Drawn {
        std::uint64_t pixels = 0;  // that it covers; 0: there was none
        bool may_go_on = false;    // else it was the nearest
    };
    /// Blocks.
    Drawn drawn() const;

 private:
    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel begin_, draw_;
    GrowingArray<float> keys_;
    GrowingArray<uint> ids_, drawn_;
    View view_{};
    bool is_first_ = true;
};

}  // namespace kilolux
