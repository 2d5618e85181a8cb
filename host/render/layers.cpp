// SPDX-License-Identifier: Apache-2.0
#include "host/render/layers.h"

#include "host/base/formats/gbuffer_layout.h"
#include "host/base/system/interrupt.h"
#include "host/gpu/repeat_until_fits.h"

namespace kilolux {

Layers::Layers(RenderContext& context)
    : context_(context),
      plan_(context.plan.of_layers()),
      draw_list_(context.scene->scene()),
      bin_(context.resolving_gpu(), context.tuning),
      raster_(context.resolving_gpu(), context.tuning),
      resolve_(context.resolving_gpu(), context.tuning, plan_.kernels,
               context.surface_features(plan_)),
      blend_(context.resolving_gpu(), context.tuning, plan_.kernels,
             context.surface_features(plan_)) {
    const KernelFeatures& features = plan_.kernels;
    const SurfaceFeatures surfaces = context.surface_features(plan_);
    if (features.shadows) origins_.emplace(context.resolving_gpu(), context.tuning, features);
    if (context.settings.renderer == RendererKind::deferred) {
        lighting_.emplace(context.gpu, context.tuning, features, surfaces);
    } else {
        all_.emplace(context.gpu, context.tuning, features, surfaces);
    }
}

TriangleLists Layers::list_triangles(const SurfaceBuffers& scene, std::span<const Draw> draws,
                                     const View& view, StageTimer& timer) {
    const uint triangles = drawn_triangles(draws, context_.scene->scene());
    return repeat_until_fits(
        timer, [&] { return bin_.enqueue(scene, triangles, view, timer); },
        [&] { return bin_.fits(bin_.pairs()); });
}

Radiance Layers::light(const LitBand& layer, StageTimer& timer) {
    const LightingInput input{layer.surfaces, layer.lights, layer.grid, layer.shadows};
    const float ambient = context_.settings.ambient;
    if (all_) {
        all_->set_ambient(ambient);
        return all_->enqueue(input, timer);
    }
    lighting_->set_ambient(ambient);
    return lighting_->light(input, timer);
}

void Layers::draw(const Sample& sample, const LitBand& band, EnvironmentLight& environment,
                  Measured out) {
    const View& view = band.surfaces.view;
    const RenderSettings& settings = context_.settings;
    const std::vector<Draw> draws =
        draw_list_.visible(crop(sample.camera, settings.height, sample.band), settings.width,
                           sample.band.rows, true, DrawOrder::front_to_back);
    if (draws.empty()) return;
    const SurfaceBuffers scene = context_.device_surfaces().at(draws);
    const TriangleLists lists = list_triangles(scene, draws, view, out.timer);
    raster_.begin(band.surfaces, out.timer);
    LitBand layer;
    layer.lights = band.lights;
    layer.grid = band.grid;
    layer.shadows = band.shadows;
    while (true) {
        check_interrupt();
        const DeviceArray<uint> ids = raster_.enqueue(scene, lists, out.timer);
        if (raster_.pixels() == 0) return;
        layer.surfaces = resolve_.enqueue(
            ids, scene, make_gbuffer_layout(plan_.gbuffer, view.stride, view.height), view,
            out.timer);
        if (origins_) {
            layer.shadows.origins = origins_->enqueue(
                ids, scene, layer.surfaces, layer.shadows.casters, layer.shadows.view, out.timer);
        }
        layer.light = light(layer, out.timer);
        environment.enqueue(layer, out.timer);
        blend_.enqueue(ids, scene, layer.surfaces, layer.light, band.light, out.timer);
    }
}

}  // namespace kilolux
