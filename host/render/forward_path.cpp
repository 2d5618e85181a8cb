// SPDX-License-Identifier: Apache-2.0
#include "host/render/forward_path.h"

#include <cmath>

#include "host/render/host_stages.h"

namespace kilolux {

ForwardPath::ForwardPath(const PathContext& context)
    : context_(context),
      clustered_(context.settings.renderer == RendererKind::forward_plus),
      forward_(context.meshes(), forward_features(context.plan, clustered_, true)),
      radiance_(context.gpu, kForwardStage) {
    if (clustered_) coarse_.emplace(context.gpu, context.tuning, context.plan.kernels);
}

HostCoarseLists ForwardPath::make_lists(const Sample& sample, const View& view, Measured out) {
    const CoarseLighting coarse = coarse_->run(sample.lights, view, grid_, out.timer);
    out.stats.coarse_pairs = coarse_->pairs();
    return coarse_->download(coarse);
}

Radiance ForwardPath::light(const Sample& sample, Measured out, const AfterShading& then) {
    const RenderSettings& settings = context_.settings;
    const View view = view_of(sample.camera, settings.width, settings.height);
    grid_ = coarse_grid(context_, sample.camera, out.stats);
    local_lights_ = sample.lights.count;
    if (clustered_) lists_ = make_lists(sample, view, out);
    const std::size_t size = std::size_t{3} * view.stride * view.height;
    const Radiance radiance{radiance_.reserve(size), view};
    std::vector<float> background;
    if (settings.background) {
        (*context_.background)->enqueue_everywhere(radiance, out.timer);
        background = download<float>(context_.gpu, radiance.planes, size);
    }
    forward_.draw(sample.camera, settings.width, settings.height,
                  forward_lights(sample, settings.ambient, clustered_ ? &lists_ : nullptr),
                  background);
    const std::vector<float> planes = forward_.read_radiance(view.stride);
    upload<float>(context_.gpu, radiance.planes, planes);
    add_host_time(out, clustered_ ? kForwardPlusStage : kForwardStage, forward_.last_ms());
    then(radiance);
    out.stats.evaluations_per_pixel = -1.0;
    out.stats.useful_evaluations_per_pixel = -1.0;
    if (settings.want.counts) {
        out.stats.evaluations_per_pixel = mean_of_drawn(pixels(sample.camera).evaluated);
    }
    return radiance;
}

SurfacePass& ForwardPath::drawn_surfaces(const Camera& camera) {
    if (!surfaces_) surfaces_.emplace(context_);
    StageTimer timer;
    FrameStats stats;
    const LightRows no_rows;
    gbuffer_ = surfaces_->draw_whole({camera, no_rows, {}, {0, context_.settings.height}, true},
                                     {timer, stats});
    return *surfaces_;
}

std::vector<uint> ForwardPath::evaluated(const Camera& camera, const DecodedSurfaces& surfaces) {
    const View& view = surfaces.view;
    std::vector<uint> out(std::size_t{view.stride} * view.height, kBackground);
    std::vector<float> fragments;
    if (!clustered_) {
        if (!overdraw_) overdraw_.emplace(context_.meshes());
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
    SurfacePass& surfaces = drawn_surfaces(camera);
    PixelProbe out = surfaces.probe(gbuffer_, grid_, x, y);
    if (!out.drawn() || !clustered_) return out;
    const uint cluster = cluster_index(grid_, out.tile_x, out.tile_y, out.slice);
    out.has_list = true;
    for (uint i = lists_.offsets[cluster]; i < lists_.offsets[cluster + 1]; ++i) {
        out.lights.push_back({lists_.lists[i], {}, {}, {}, {}});
    }
    out.coarse_count = static_cast<uint>(out.lights.size());
    return out;
}

DecodedSurfaces ForwardPath::pixels(const Camera& camera) {
    SurfacePass& surfaces = drawn_surfaces(camera);
    DecodedSurfaces out = surfaces.decode(gbuffer_, grid_);
    out.evaluated = evaluated(camera, out);
    return out;
}

}  // namespace kilolux
