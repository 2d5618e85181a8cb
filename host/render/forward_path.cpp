// SPDX-License-Identifier: Apache-2.0
#include "host/render/forward_path.h"

#include <cmath>

#include "host/render/forward_inputs.h"

namespace kilolux {

ForwardPath::ForwardPath(const RenderContext& context)
    : context_(context),
      clustered_(context.settings.renderer == RendererKind::forward_plus),
      forward_(context.gpu_scene, forward_features(context.plan, clustered_, true)),
      radiance_(context.gpu, "forward") {
    if (clustered_) coarse_.emplace(context.gpu, context.tuning, context.plan.kernels);
}

HostCoarseLists ForwardPath::make_lists(const SampleInput& sample, const View& view,
                                        StageTimer& timer, FrameStats& stats) {
    CoarseResult result = coarse_->enqueue(sample.lights, view, grid_, timer);
    while (!coarse_->fit()) {
        timer.take();
        result = coarse_->enqueue(sample.lights, view, grid_, timer);
    }
    stats.coarse_pairs = coarse_->pairs();
    return coarse_->download(result);
}

Radiance ForwardPath::light(const SampleInput& sample, StageTimer& timer, FrameStats& stats) {
    const RenderSettings& settings = context_.settings;
    const View view = view_of(sample.camera, settings.width, settings.height);
    grid_ = coarse_grid(context_, sample.camera, stats);
    local_lights_ = sample.lights.count;
    if (clustered_) lists_ = make_lists(sample, view, timer, stats);
    forward_.draw(sample.camera, settings.width, settings.height,
                  forward_lights(sample.rows, settings.ambient, clustered_ ? &lists_ : nullptr));
    const std::vector<float> planes = forward_.read_radiance(view.stride);
    Radiance radiance{radiance_.reserve(planes.size() * sizeof(float)), view};
    upload<float>(context_.gpu, radiance.planes, planes);
    add_stage_time(stats.stages, clustered_ ? "forward_plus" : "forward", forward_.last_ms());
    stats.evaluations_per_pixel = -1.0;
    stats.useful_evaluations_per_pixel = -1.0;
    if (settings.count_useful) {
        stats.evaluations_per_pixel = mean_of_drawn(pixels(sample.camera).evaluated);
    }
    return radiance;
}

std::vector<uint> ForwardPath::evaluated(const Camera& camera, const DecodedSurfaces& surfaces) {
    const View& view = surfaces.view;
    std::vector<uint> out(std::size_t{view.stride} * view.height, kBackground);
    std::vector<float> fragments;
    if (!clustered_) {
        if (!overdraw_) overdraw_.emplace(context_.gpu_scene);
        fragments = overdraw_->count(camera, context_.settings.width, context_.settings.height,
                                     DrawOrder::scene);
    }
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            const std::size_t pixel = y * view.stride + x;
            const std::optional<uint> cluster = coarse_cluster_at(surfaces, pixel);
            if (!cluster) continue;
            out[pixel] =
                clustered_
                    ? lists_.offsets[*cluster + 1] - lists_.offsets[*cluster]
                    : local_lights_ * static_cast<uint>(std::lround(fragments[y * view.width + x]));
        }
    }
    return out;
}

PixelProbe ForwardPath::probe(const Camera& camera, int x, int y) {
    if (!surfaces_) surfaces_.emplace(context_);
    std::vector<StageTime> untimed;
    PixelProbe out = surfaces_->probe(
        surfaces_->draw(camera, {0, context_.settings.height}, true, untimed), grid_, x, y);
    if (!out.drawn() || !clustered_) return out;
    const uint cluster = cluster_index(grid_, out.tile_x, out.tile_y, out.slice);
    out.has_list = true;
    for (uint i = lists_.offsets[cluster]; i < lists_.offsets[cluster + 1]; ++i) {
        out.lights.push_back({lists_.lists[i], {}, {}});
    }
    out.coarse_count = static_cast<uint>(out.lights.size());
    return out;
}

DecodedSurfaces ForwardPath::pixels(const Camera& camera) {
    if (!surfaces_) surfaces_.emplace(context_);
    std::vector<StageTime> untimed;
    DecodedSurfaces out = surfaces_->decode(
        surfaces_->draw(camera, {0, context_.settings.height}, true, untimed), grid_);
    out.evaluated = evaluated(camera, out);
    return out;
}

}  // namespace kilolux
