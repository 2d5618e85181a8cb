// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/blended_layers.h"

#include <utility>

#include "host/base/system/interrupt.h"
#include "host/gpu/repeat_until_fits.h"

namespace kilolux {

BlendedLayers::BlendedLayers(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                             SurfacePlan plan)
    : scene_(scene),
      plan_(std::move(plan)),
      draw_list_(scene),
      bin_(gpu, tuning),
      raster_(gpu, tuning),
      resolve_(gpu, tuning, plan_.kernels, plan_.surfaces) {}

TriangleLists BlendedLayers::list_triangles(const SurfaceBuffers& scene,
                                            std::span<const Draw> draws, const View& view,
                                            StageTimer& timer) {
    const uint triangles = drawn_triangles(draws, scene_);
    return repeat_until_fits(
        timer, [&] { return bin_.enqueue(scene, triangles, view, timer); },
        [&] { return bin_.fits(bin_.pairs()); });
}

void BlendedLayers::each(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
                         StageTimer& timer, const std::function<void(const BlendedLayer&)>& visit) {
    const View& view = opaque.view;
    const std::vector<Draw> draws =
        draw_list_.visible(camera, static_cast<int>(view.width), static_cast<int>(view.height),
                           true, DrawOrder::front_to_back);
    if (draws.empty()) return;
    BlendedLayer layer;
    layer.draws = draws;
    layer.scene = on_device.at(draws);
    const TriangleLists lists = list_triangles(layer.scene, draws, view, timer);
    raster_.begin(opaque, timer);
    for (RasterLayers::Drawn drawn{0, true}; drawn.may_go_on;) {
        check_interrupt();
        layer.ids = raster_.enqueue(layer.scene, lists, timer);
        drawn = raster_.drawn();
        layer.pixels = drawn.pixels;
        if (layer.pixels == 0) return;
        layer.surfaces = resolve_.enqueue(
            layer.ids, layer.scene, make_gbuffer_layout(plan_.gbuffer, view.stride, view.height),
            view, timer);
        visit(layer);
    }
}

}  // namespace kilolux
