// SPDX-License-Identifier: Apache-2.0
#include "host/render/layers.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace kilolux {

SurfacePlan layer_plan(const RenderContext& context) {
    const ScenePlan plan = context.plan.of_layers();
    return {plan.kernels, context.surface_features(plan), plan.gbuffer};
}

namespace {

// Fine tiles of all layers that show a triangle. ids: [height][stride].
std::uint64_t covered_tiles(const std::vector<uint>& ids, const View& view) {
    std::vector<char> covered(fine_tile_count(view), 0);
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            if (ids[std::size_t{y} * view.stride + x] == 0) continue;
            covered[fine_tile_of(view, x, y)] = 1;
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

Radiance Layers::light(const LitBand& layers, const LitBand& behind, StageTimer& timer) {
    const LightingInput input{layers.surfaces, layers.lights, layers.grid, layers.shadows,
                              &behind.lists};
    const float ambient = context_.settings.ambient;
    if (all_) {
        all_->set_ambient(ambient);
        return all_->enqueue(input, timer);
    }
    lighting_->set_ambient(ambient);
    return lighting_->light(input, timer);
}

void Layers::draw(BlendedLayers& layers, const LitBand& band, EnvironmentLight& environment,
                  Measured out) {
    LitBand lit;
    lit.lights = band.lights;
    lit.grid = band.grid;
    lit.shadows = band.shadows;
    std::uint64_t count = 0;
    layers.each(out.timer, [&](const LayerStack& next) {
        count += next.pixels.size();
        out.stats.layer_pixels = std::accumulate(next.pixels.begin(), next.pixels.end(),
                                                 std::uint64_t{out.stats.layer_pixels});
        if (context_.settings.want.counts) {
            const View& view = next.surfaces.view;
            out.stats.layer_tiles += covered_tiles(
                download<uint>(context_.gpu, next.ids, std::size_t{view.stride} * view.height),
                view);
        }
        lit.surfaces = next.surfaces;
        if (origins_) {
            lit.shadows.origins =
                origins_->enqueue(next.ids, next.scene, lit.surfaces, lit.shadows.casters,
                                  lit.shadows.view, out.timer);
        }
        lit.light = light(lit, band, out.timer);
        environment.reflect_in_layer(lit.surfaces, lit.light, out.timer);
        blend_.enqueue(next.ids, next.scene, lit.surfaces, lit.light, band.light, out.timer);
    });
    out.stats.layers = std::max(out.stats.layers, count);
}

}  // namespace kilolux
