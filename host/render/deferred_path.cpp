// SPDX-License-Identifier: Apache-2.0
#include "host/render/deferred_path.h"

#include "host/render/forward_inputs.h"

namespace kilolux {

DeferredPath::DeferredPath(const RenderContext& context)
    : context_(context),
      all_lights_(context.settings.renderer == RendererKind::deferred_all),
      surfaces_(context),
      prepare_(context.gpu, context.tuning),
      list_stages_(context.gpu, context.tuning, context.plan.kernels),
      shade_(context.gpu, context.tuning, context.plan.kernels),
      count_lights_(context.gpu, context.tuning, context.plan.kernels) {
    if (has_blended_surfaces(context.gpu_scene.scene())) {
        list_stages_.list_everywhere();
        blended_.emplace(context.gpu_scene, forward_features(context.plan, !all_lights_, false));
    }
}

Radiance DeferredPath::light(const SampleInput& sample, StageTimer& timer, FrameStats& stats) {
    shade_.set_ambient(context_.settings.ambient);
    gbuffer_ = surfaces_.draw(sample.camera, sample.band, sample.redraw, stats.stages);
    grid_ = coarse_grid(context_, sample.camera, stats);
    local_lights_ = sample.lights.count;
    Radiance radiance =
        all_lights_ ? light_from_all(sample, timer, stats) : light_from_lists(sample, timer, stats);
    if (blended_) blend(sample, radiance, stats);
    return radiance;
}

Radiance DeferredPath::light_from_all(const SampleInput& sample, StageTimer& timer,
                                      FrameStats& stats) {
    lists_ = {};
    lists_.lights = prepare_.enqueue(sample.lights, gbuffer_.view, grid_, timer);
    stats.evaluations_per_pixel = sample.lights.count;
    stats.useful_evaluations_per_pixel = -1.0;
    if (!shade_all_) shade_all_.emplace(context_.gpu, context_.tuning, context_.plan.kernels);
    shade_all_->set_ambient(context_.settings.ambient);
    return shade_all_->enqueue(gbuffer_, lists_.lights, timer);
}

Radiance DeferredPath::light_from_lists(const SampleInput& sample, StageTimer& timer,
                                        FrameStats& stats) {
    const auto enqueue = [&] {
        lists_ = list_stages_.enqueue(sample.lights, gbuffer_, grid_, timer);
        return shade_.enqueue(gbuffer_, lists_.lights, grid_, lists_.clusters, lists_.refined,
                              timer);
    };
    Radiance radiance = enqueue();
    // Room for the lists is last frame's: where that was too little, grow it and do this one again.
    while (!list_stages_.fit()) {
        timer.take();
        radiance = enqueue();
    }
    list_stages_.count(lists_, stats);
    stats.useful_evaluations_per_pixel = -1.0;
    if (context_.settings.count_useful) {
        const std::size_t size = std::size_t{gbuffer_.view.stride} * gbuffer_.view.height;
        const cl::Buffer covering = count_lights().covering;
        stats.useful_evaluations_per_pixel =
            mean_of_drawn(download<uint>(context_.gpu, covering, size));
    }
    return radiance;
}

LitSurfaces DeferredPath::lit_surfaces() {
    const PreparedLights& lights = lists_.lights;
    return {pixels(), download<ShadeLight>(context_.gpu, lights.lights, lights.count),
            download<DirectionalLight>(context_.gpu, lights.directional, lights.directional_count)};
}

PixelProbe DeferredPath::probe(int x, int y) {
    PixelProbe out = surfaces_.probe(gbuffer_, grid_, x, y);
    if (out.drawn() && !all_lights_) list_stages_.probe(lists_, gbuffer_.view, x, y, out);
    return out;
}

LightCounts DeferredPath::count_lights() {
    StageTimer untimed;
    return count_lights_.enqueue(gbuffer_, lists_.lights, grid_, lists_.clusters, lists_.refined,
                                 untimed);
}

void DeferredPath::blend(const SampleInput& sample, const Radiance& radiance, FrameStats& stats) {
    const View& view = radiance.view;
    const auto planes =
        download<float>(context_.gpu, radiance.planes, std::size_t{3} * view.stride * view.height);
    HostCoarseLists lists;
    if (!all_lights_) lists = list_stages_.download_coarse(lists_);
    blended_->draw_blended(
        crop(sample.camera, context_.settings.height, sample.band), view, surfaces_.targets(),
        planes,
        forward_lights(sample.rows, context_.settings.ambient, all_lights_ ? nullptr : &lists));
    upload<float>(context_.gpu, radiance.planes, blended_->read_radiance(view.stride));
    add_stage_time(stats.stages, "blended", blended_->last_ms());
}

DecodedSurfaces DeferredPath::pixels() {
    DecodedSurfaces out = surfaces_.decode(gbuffer_, grid_);
    const std::size_t size = std::size_t{out.view.stride} * out.view.height;
    if (all_lights_) {
        out.evaluated.resize(size);
        for (std::size_t i = 0; i < size; ++i) {
            out.evaluated[i] = out.planes[i] == 0.0f ? kBackground : local_lights_;
        }
        return out;
    }
    const LightCounts counts = count_lights();
    out.evaluated = download<uint>(context_.gpu, counts.evaluated, size);
    out.covering = download<uint>(context_.gpu, counts.covering, size);
    return out;
}

}  // namespace kilolux
