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

Layers::Layers(RenderContext& context, BlendedLayers& surfaces)
    : context_(context),
      surfaces_(surfaces),
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

void Layers::begin(const Sample& sample, const LitBand& band, StageTimer& timer) {
    first_ = surfaces_.begin(context_.device_surfaces(),
                             crop(sample.camera, context_.settings.height, sample.band),
                             band.surfaces, timer);
    if (!lighting_) return;
    lighting_->release();
    if (!first_) lighting_->forget();
}

MorePixels Layers::more_pixels() {
    if (!first_ || !lighting_) return {};
    return {&lighting_->light_lists(), first_->surfaces};
}

Radiance Layers::light(const LightingInput& input, StageTimer& timer) {
    const float ambient = context_.settings.ambient;
    if (all_) {
        all_->set_ambient(ambient);
        return all_->enqueue(input, timer);
    }
    lighting_->set_ambient(ambient);
    return input.others ? lighting_->enqueue(input, timer) : lighting_->light(input, timer);
}

// `others`: that of LightingInput.
void Layers::lay(const LayerStack& stack, const ListedLights* others, LitBand& band,
                 EnvironmentLight& environment, StageTimer& timer) {
    LightingInput input{stack.surfaces, band.lights, band.grid, band.shadows, others};
    if (origins_) {
        input.shadows.origins = origins_->enqueue(stack.ids, stack.scene, stack.surfaces,
                                                  band.shadows.casters, band.shadows.view, timer);
    }
    const Radiance lit = light(input, timer);
    environment.reflect_in_layer(stack.surfaces, lit, timer);
    blend_.enqueue(stack.ids, stack.scene, stack.surfaces, lit, band.light, timer);
}

void Layers::draw(LitBand& band, EnvironmentLight& environment, StageTimer& timer) {
    if (first_) lay(*first_, &band.lists, band, environment, timer);
}

bool Layers::lists_fit(StageTimer& timer) {
    return !first_ || !lighting_ || lighting_->fits(timer);
}

// Returns the number of layers that cover any pixel.
std::uint64_t Layers::count(const LayerStack& stack, FrameStats& stats) const {
    stats.layer_pixels = std::accumulate(stack.pixel_counts.begin(), stack.pixel_counts.end(),
                                         std::uint64_t{stats.layer_pixels});
    if (context_.settings.want.counts) {
        const View& view = stack.surfaces.view;
        stats.layer_tiles += covered_tiles(
            download<uint>(context_.gpu, stack.ids, std::size_t{view.stride} * view.height), view);
    }
    return stack.pixel_counts.size();
}

bool Layers::draw_rest(LitBand& band, EnvironmentLight& environment, Measured out) {
    if (!first_) return false;
    const std::uint64_t first = count(*first_, out.stats);
    std::uint64_t layers = first;
    while (const LayerStack* stack = surfaces_.next(out.timer)) {
        layers += count(*stack, out.stats);
        lay(*stack, nullptr, band, environment, out.timer);
    }
    out.stats.layers = std::max(out.stats.layers, layers);
    return layers > first;
}

}  // namespace kilolux
