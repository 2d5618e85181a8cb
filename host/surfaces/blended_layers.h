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
/// of the picture in which there are any, once for each layer, one below the other.
struct LayerStack {
    DeviceArray<uint> ids;  // [height][stride], of the draws' triangles; 0: it does not cover it
    SurfaceBuffers scene;   // of the draws
    std::span<const Draw> draws;
    GBuffer surfaces;
    std::vector<std::uint64_t> pixels;  // that each layer covers, at least one

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

    /// Draws the farthest layers in front of `opaque`, which shows what `camera` sees. Enqueues
    /// only; `on_device` must not be asked for other draws before each().
    void begin(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
               StageTimer& timer);

    /// Calls `visit` with all layers in turn; a stack is valid during the call. Blocks. Throws
    /// Error as the stages do, Interrupted between stacks.
    void each(StageTimer& timer, const std::function<void(const LayerStack&)>& visit);

 private:
    void draw_first(StageTimer& timer);

    const Scene& scene_;
    SurfacePlan plan_;
    DrawList draw_list_;
    BinTriangles bin_;
    RasterLayers raster_;
    ResolveSurfaces resolve_;
    // Since begin().
    GBuffer opaque_;
    std::vector<Draw> draws_;
    SurfaceBuffers on_device_;
    View region_{};
    TriangleLists lists_;
    LayerIds drawn_;
};

}  // namespace kilolux
