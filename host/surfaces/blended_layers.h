// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/base/formats/gbuffer_layout.h"
#include "host/scene/camera.h"
#include "host/scene/draw_list.h"
#include "host/stages/surfaces/bin_triangles.h"
#include "host/stages/surfaces/raster_layers.h"
#include "host/stages/surfaces/resolve_surfaces.h"
#include "host/surfaces/surface_scene.h"

namespace kilolux {

/// What of a scene's surfaces is compiled in and stored.
struct SurfacePlan {
    KernelFeatures kernels;
    SurfaceFeatures surfaces;
    GBufferNeeds gbuffer;
};

/// Neighbouring layers of the surfaces that blend, from far to near. The planes hold the rectangle
/// of the picture in which there may be any, once for each layer, one below the other; the last
/// ones may be empty.
struct LayerStack {
    DeviceArray<uint> ids;  // [height][stride], of the draws' triangles; 0: it does not cover it
    SurfaceBuffers scene;   // of the draws
    std::span<const Draw> draws;
    GBuffer surfaces;
    std::vector<std::uint64_t> pixels;  // that each layer covers which covers any

    /// Where pixel (x, y) of the picture lies in the planes of layer `layer`; none: beside them.
    std::optional<std::size_t> place(std::size_t layer, uint x, uint y) const;
};

/// The surfaces that blend over others, as G-buffers: at each pixel from far to near, whatever
/// their order in the scene. The number of layers has no limit.
class BlendedLayers {
 public:
    static constexpr std::size_t kPixelBytes = RasterLayers::kPixelBytes;

    /// The scene must outlive this; its instances may move, its meshes must stay as many.
    BlendedLayers(const Gpu& gpu, const Tuning& tuning, const Scene& scene, SurfacePlan plan);

    /// The farthest layers in front of `opaque`, which shows what `camera` sees; null: none is in
    /// view. They stay while opaque.version does, which their surfaces take over. Enqueues only;
    /// valid until the next call of begin() or next().
    const LayerStack* begin(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
                            StageTimer& timer);

    /// False where the last begin() had too little room: it must be called again, and then has it.
    /// Else its stack's `pixels` are there. Blocks.
    bool fits();

    /// Whether begin() drew as many layers as there were the last time.
    bool may_be_all() const { return found_before_ <= layer_count(stack_.surfaces.view); }

    /// The layers in front of the last ones, of which `pixels` are there; null: there are none.
    /// Blocks. Throws Error as the stages do, and Interrupted.
    const LayerStack* next(StageTimer& timer);

    /// Calls `visit` with all layers in turn. Blocks. Throws as the others do.
    void each(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
              const std::function<void(const LayerStack&)>& visit);

 private:
    void draw_layers(StageTimer& timer);
    void count_drawn();

    const Scene& scene_;
    SurfacePlan plan_;
    DrawList draw_list_;
    BinTriangles bin_;
    RasterLayers raster_;
    ResolveSurfaces resolve_;
    // Of the last begin().
    std::vector<Draw> draws_;
    TriangleLists lists_;
    std::uint64_t version_ = 0;  // of what lies behind; 0: the stack is another one
    // Of the last stack.
    LayerStack stack_;
    bool goes_on_ = false;  // there may be further layers
    bool is_counted_ = false;
    std::size_t found_ = RasterLayers::kMostLayers;  // layers since begin()
    std::size_t found_before_ = 0;                   // since the one before
};

}  // namespace kilolux
