// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
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

/// One layer of the surfaces that blend.
struct BlendedLayer {
    DeviceArray<uint> ids;  // [height][stride], of the draws' triangles; 0: it does not cover it
    SurfaceBuffers scene;   // of the draws
    std::span<const Draw> draws;
    GBuffer surfaces;
    std::uint64_t pixels = 0;  // that it covers, at least one
};

/// The surfaces that blend over others, as G-buffers: at each pixel from far to near, whatever
/// their order in the scene. The number of layers has no limit.
class BlendedLayers {
 public:
    static constexpr std::size_t kPixelBytes = RasterLayers::kPixelBytes;

    /// The scene must outlive this; its instances may move, its meshes must stay as many.
    BlendedLayers(const Gpu& gpu, const Tuning& tuning, const Scene& scene, SurfacePlan plan);

    /// Calls `visit` with each layer in front of `opaque`, which shows what `camera` sees; a layer
    /// is valid during the call. Blocks. Throws Error as the stages do, Interrupted between layers.
    void each(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
              StageTimer& timer, const std::function<void(const BlendedLayer&)>& visit);

 private:
    TriangleLists list_triangles(const SurfaceBuffers& scene, std::span<const Draw> draws,
                                 const View& view, StageTimer& timer);

    const Scene& scene_;
    SurfacePlan plan_;
    DrawList draw_list_;
    BinTriangles bin_;
    RasterLayers raster_;
    ResolveSurfaces resolve_;
};

}  // namespace kilolux
