// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
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
    std::vector<std::uint64_t> pixel_counts;  // of each layer that covers any

    /// The place in the planes of the picture's pixel (x, y) in layer `layer`; none where the
    /// rectangle does not hold it.
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
    /// view. They are kept while opaque.version is the same, and have a version of their own if it
    /// is known. Enqueues only; valid until the next call of begin() or next().
    const LayerStack* begin(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
                            StageTimer& timer);

    /// False where the last begin() had too little room: it must be called again, and then has it.
    /// Else its stack's pixel_counts are there. Blocks.
    bool fits();

    /// Before its layers are counted: whether the last stack has as many as there were the last
    /// time. After: whether it has all.
    bool expects_no_more() const {
        return is_counted_ ? !goes_on_ : expected_ <= layer_count(stack_.surfaces.view);
    }

    /// The layers in front of the last ones, of which pixel_counts are there; null: there are none.
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
    std::uint64_t behind_ = 0;   // version that the stack was drawn against; 0: draw it again
    std::uint64_t version_ = 0;  // of the last stack that has one
    std::size_t expected_ = 0;   // layers
    // Layers that were there the last time, by their band's first row.
    std::map<uint, std::size_t> layers_;
    uint first_row_ = 0;  // of this band
    // Of the last stack.
    LayerStack stack_;
    bool goes_on_ = false;  // there may be further layers
    bool is_counted_ = false;
};

}  // namespace kilolux
