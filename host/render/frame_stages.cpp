// SPDX-License-Identifier: Apache-2.0
#include "host/render/frame_stages.h"

#include <algorithm>

namespace kilolux {

FrameStages::FrameStages(RenderContext& context) : context_(context) {
    const Gpu& gpu = context.gpu;
    const Tuning& tuning = context.tuning;
    const KernelFeatures& features = context.plan.kernels;
    const RendererKind kind = context.settings.renderer;
    if (is_forward(kind)) {
        forward_.emplace(context);
        if (kind == RendererKind::forward_plus) coarse_.emplace(gpu, tuning, features);
        return;
    }
    surfaces_.emplace(context);
    if (kind == RendererKind::deferred) {
        lists_.emplace(gpu, tuning, features);
        if (features.shadows) {
            visibility_.emplace(gpu, tuning, features, context.surface_features());
        }
        shade_.emplace(gpu, tuning, features, context.surface_features());
        if (context.shades_display()) {
            shade_->build(static_cast<int>(context.settings.tone_curve));
        } else {
            shade_->build({});
        }
    } else {
        shade_all_.emplace(gpu, tuning, features, context.surface_features());
    }
    if (!context.blends()) return;
    layers_.emplace(context, layer_surfaces());
}

void FrameStages::draw_surfaces(const Sample& sample, LitBand& band, Measured out) {
    band = {};
    band.lights = sample.lights;
    band.grid = context_.coarse_grid(sample.camera);
    std::ranges::copy(std::array{band.grid.tiles_x, band.grid.tiles_y, band.grid.slices},
                      out.stats.grid);
    if (forward_) {
        band.light = forward_->target(sample);
        return;
    }
    band.surfaces = surfaces_->enqueue(sample, out);
    band.shadows = surfaces_->shadows(sample);
    if (layers_) layers_->begin(sample, band, out.timer);
}

void FrameStages::list_lights(const Sample& sample, LitBand& band, Measured out) {
    if (lists_) {
        const MorePixels more = layers_ ? layers_->more_pixels() : MorePixels{};
        if (visibility_ && !lists_->has_made(sample.lights, band.surfaces, band.grid, more)) {
            visibility_->save_last(*lists_, sample.lights, band.surfaces, out.timer);
        }
        band.lists = lists_->enqueue(sample.lights, band.surfaces, band.grid, out.timer, more);
    }
    if (!coarse_) return;
    const View view =
        view_of(sample.camera, context_.settings.width, context_.settings.height, sample.band);
    const CoarseLighting coarse = coarse_->enqueue(sample.lights, view, band.grid, out.timer);
    has_coarse_ = coarse_->fits(coarse_->pairs());
    if (has_coarse_) band.coarse = coarse_->download(coarse);
}

void FrameStages::find_visible(LitBand& band, Measured out) {
    if (!visibility_) return;
    visibility_->set_ambient(context_.settings.ambient);
    band.visible = visibility_->enqueue(band.lists, band.surfaces, band.shadows, out.timer);
}

void FrameStages::shade(const Sample& sample, LitBand& band, Measured out) {
    const float ambient = context_.settings.ambient;
    if (shade_) {
        shade_->set_ambient(ambient);
        band.light = shade_->enqueue(band.lists.at(band.surfaces), out.timer,
                                     {band.visible.words, band.visible.samples, band.shadows},
                                     sample.display);
        band.display = sample.display;
    } else if (shade_all_) {
        shade_all_->set_ambient(ambient);
        band.light =
            shade_all_->enqueue({band.surfaces, band.lights, band.grid, band.shadows}, out.timer);
    } else if (has_coarse_) {
        forward_->draw(sample, coarse_ ? &band.coarse : nullptr, band.light, out);
    }
}

void FrameStages::count(Measured out) {
    if (lists_) lists_->start_count(out.timer);
    if (surfaces_ && !forward_) surfaces_->start_count(out.timer);
}

Room FrameStages::room(const LitBand& band, Measured out) {
    Room out_room;
    out_room.lists = lists_ ? lists_->fits(out.timer) : has_coarse_;
    if (visibility_ && out_room.lists) out_room.lists = visibility_->fits(*lists_);
    out_room.surfaces = forward_ || surfaces_->fits(out.stats);
    if (layers_) {
        const bool surfaces = layers_->surfaces_fit(), lists = layers_->lists_fit(out.timer);
        out_room.surfaces = out_room.surfaces && surfaces;
        out_room.lists = out_room.lists && lists;
    }
    if (coarse_ && has_coarse_) out.stats.coarse_pairs = band.coarse.offsets.back();
    if (lists_) static_cast<PairCounts&>(out.stats) = lists_->counts();
    return out_room;
}

void FrameStages::blend(LitBand& band, EnvironmentLight& environment, Measured out) {
    if (layers_) layers_->draw(band, environment, out.timer);
}

bool FrameStages::blend_rest(LitBand& band, EnvironmentLight& environment, Measured out) {
    return layers_ && layers_->draw_rest(band, environment, out);
}

BlendedLayers& FrameStages::layer_surfaces() {
    if (!layer_surfaces_) {
        layer_surfaces_.emplace(context_.resolving_gpu(), context_.tuning, context_.scene->scene(),
                                layer_plan(context_));
    }
    return *layer_surfaces_;
}

void FrameStages::draw_missing_surfaces(const Camera& camera, LitBand& band) {
    if (!forward_) return;
    if (!surfaces_) surfaces_.emplace(context_);
    StageTimer timer;
    FrameStats stats;
    const LightRows no_rows;
    band.surfaces =
        surfaces_->draw({camera, no_rows, {}, {0, context_.settings.height}}, {timer, stats});
}

}  // namespace kilolux
