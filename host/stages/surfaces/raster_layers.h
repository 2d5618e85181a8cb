// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

inline constexpr StageInfo kRasterLayersStage = {"raster_layers", StageGroup::surfaces};

/// Layers of triangle ids, from far to near, one below the other.
struct LayerIds {
    DeviceArray<uint> ids;  // [view.height][view.stride], as RasterTriangles has them
    View view{};            // of all layers, whether or not they show anything
};

/// Draws surfaces that blend over others as triangle ids, layer by layer from far to near.
class RasterLayers {
 public:
    static constexpr std::size_t kPixelBytes = sizeof(float) + sizeof(uint);  // a key and an id
    static constexpr std::size_t kMostLayers = 8;                             // of an enqueue()

    RasterLayers(const Gpu& gpu, const Tuning& tuning);

    /// Starts anew: the next enqueue() draws the farthest layers in front of `opaque`, in the
    /// rectangle `region` of its planes. Enqueues only.
    void begin(const GBuffer& opaque, const View& region, std::size_t layers, StageTimer& timer);

    /// At most as many layers as begin() has asked for; fewer where planes of the size of `opaque`
    /// have no room for them, but at least one. `lists`: of the triangles of `scene`'s instances
    /// that blend, in `region`. Enqueues only; valid until the next call.
    LayerIds enqueue(const SurfaceBuffers& scene, const TriangleLists& lists, StageTimer& timer);

    /// The last layers.
    struct Drawn {
        std::vector<std::uint64_t> pixels;  // of each layer that covers any
        bool may_go_on = false;             // else the nearest is among them
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
    View region_{}, layers_{};
    bool is_first_ = true;
};

}  // namespace kilolux
