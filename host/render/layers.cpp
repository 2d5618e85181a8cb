// SPDX-License-Identifier: Apache-2.0
#include "host/render/layers.h"

#include <algorithm>
#include <vector>

namespace kilolux {

SurfacePlan layer_plan(const RenderContext& context) {
    const ScenePlan plan = context.plan.of_layers();
    return {plan.kernels, context.surface_features(plan), plan.gbuffer};
}

namespace {

// Fine tiles that show a triangle. ids: [height][stride].
std::uint64_t covered_tiles(const std::vector<uint>& ids, const View& view) {
    const std::size_t across = (view.width + FINE_TILE - 1) / FINE_TILE;
    std::vector<char> covered(across * ((view.height + FINE_TILE - 1) / FINE_TILE), 0);
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            if (ids[y * view.stride + x] == 0) continue;
            covered[y / FINE_TILE * across + x / FINE_TILE] = 1;
        }
    }
    return static_cast<std::uint64_t>(std::ranges::count(covered, 1));
}

}  // namespace

Layers::Layers(RenderContext& context)
    : context_(context),
      blend_(context.resolving_gpu(), context.tuning, layer_plan(context).kernels,
             layer_plan(context).surfaces) {
    const SurfacePlan plan = layer_plan(context);
    if (plan.kernels.shadows) {
        origins_.emplace(context.resolving_gpu(), context.tuning, plan.kernels);
    }
    if (context.settings.renderer == RendererKind::deferred) {
        lighting_.emplace(context.gpu, context.tuning, plan.kernels, plan.surfaces);
    } else {
        all_.emplace(context.gpu, context.tuning, plan.kernels, plan.surfaces);
    }
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

void Layers::draw(const Sample& sample, BlendedLayers& layers, const LitBand& band,
                  EnvironmentLight& environment, Measured out) {
    LitBand layer;
    layer.lights = band.lights;
    layer.grid = band.grid;
    layer.shadows = band.shadows;
    std::uint64_t count = 0;
    const auto lay = [&](const BlendedLayer& next) {
        ++count;
        out.stats.layer_pixels += next.pixels;
        if (context_.settings.want.counts) {
            const View& view = next.surfaces.view;
            out.stats.layer_tiles += covered_tiles(
                download<uint>(context_.gpu, next.ids, std::size_t{view.stride} * view.height),
                view);
        }
        layer.surfaces = next.surfaces;
        if (origins_) {
            layer.shadows.origins =
                origins_->enqueue(next.ids, next.scene, layer.surfaces, layer.shadows.casters,
                                  layer.shadows.view, out.timer);
        }
        layer.light = light(layer, out.timer);
        environment.reflect_in_layer(layer.surfaces, layer.light, out.timer);
        blend_.enqueue(next.ids, next.scene, layer.surfaces, layer.light, band.light, out.timer);
    };
    layers.each(context_.device_surfaces(),
                crop(sample.camera, context_.settings.height, sample.band), band.surfaces,
                out.timer, lay);
    out.stats.layers = std::max(out.stats.layers, count);
}

}  // namespace kilolux
