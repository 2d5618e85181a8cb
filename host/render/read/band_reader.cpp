// SPDX-License-Identifier: Apache-2.0
#include "host/render/read/band_reader.h"

#include <cmath>

namespace kilolux {
namespace {

// The first `count` rows, and those of single lights among the nodes after them.
template <typename Row>
std::vector<Row> single_lights(std::vector<Row> rows, uint count,
                               const std::vector<TreeNode>& nodes) {
    std::size_t end = count;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].next == i + 1) rows[end++] = rows[count + i];
    }
    rows.resize(end);
    return rows;
}

// The place in planes `behind` of a pixel of planes of layers.
std::size_t place_behind(const View& behind, const View& view, std::size_t place) {
    const auto x = static_cast<uint>(place % view.stride);
    const auto y = static_cast<uint>(place / view.stride);
    return std::size_t{plane_row(behind, picture_row(view, y))} * behind.stride +
           plane_column(behind, picture_column(view, x));
}

// Puts what a layer shows at place `from` in place of what lies behind.
void show_layer(DecodedSurfaces& out, std::size_t to, const std::vector<float>& planes,
                std::size_t from) {
    for (std::size_t i = 0; i < SURFACE_PLANES; ++i) {
        out.planes[i * (out.planes.size() / SURFACE_PLANES) + to] =
            planes[i * (planes.size() / SURFACE_PLANES) + from];
    }
    if (out.evaluated[to] != kBackground) return;
    for (const auto counts : {&DecodedSurfaces::evaluated, &DecodedSurfaces::covering,
                              &DecodedSurfaces::facing, &DecodedSurfaces::seen}) {
        if (!(out.*counts).empty()) (out.*counts)[to] = 0;
    }
}

}  // namespace

void BandReader::count(const LastSample& last, FrameStats& stats) {
    const FrameRequest& want = context_.settings.want;
    const RendererKind kind = context_.settings.renderer;
    stats.useful_evaluations_per_pixel = -1.0;
    if (is_forward(kind)) {
        stats.evaluations_per_pixel =
            want.counts ? mean_over_surfaces(pixels(last).evaluated) : -1.0;
        return;
    }
    if (kind == RendererKind::deferred_all) {
        stats.evaluations_per_pixel = last.band.lights.count;
        return;
    }
    stats.evaluations_per_pixel = mean_list_length(stats);
    if (want.counts) {
        stats.useful_evaluations_per_pixel = mean_over_surfaces(download<uint>(
            context_.gpu, count_lights(last).covering, plane_size(last.band.surfaces.view)));
    }
    if (!want.shadow_counts || !last.stages.visibility()) return;
    if (!counting_) {
        counting_.emplace(context_.gpu, context_.tuning, context_.plan.kernels,
                          context_.surface_features(), true);
    }
    const LitBand& band = last.band;
    stats.shadows = last.stages.visibility()->count(band.lists, band.surfaces, band.shadows,
                                                    band.visible, *counting_);
}

DecodedSurfaces BandReader::pixels(const LastSample& last) {
    last.stages.draw_missing_surfaces(last.camera, last.band);
    const LitBand& band = last.band;
    DecodedSurfaces out;
    out.view = band.surfaces.view;
    out.grid = band.grid;
    out.unlit = context_.plan.gbuffer.unlit;
    out.planes = download<float>(context_.gpu, surfaces_.of_band(band),
                                 SURFACE_PLANES * plane_size(band.surfaces.view));
    count_evaluated(last, out);
    if (context_.settings.want.layers()) add_layers(last, out);
    if (context_.settings.want.illuminance()) out.illuminance = illuminance(last);
    if (band.light.groups > 0) {
        out.light = download(context_.gpu, band.light.planes, band.light.floats());
    }
    return out;
}

// Counts the layers, and with SurfaceLayer::nearest puts their surfaces in place of those behind.
void BandReader::add_layers(const LastSample& last, DecodedSurfaces& out) {
    const std::size_t size = plane_size(last.band.surfaces.view);
    out.layers.assign(size, 0);
    surfaces_.each_layer(last, [&](const LayerStack& stack) {
        const View& view = stack.surfaces.view;
        const std::size_t stack_size = plane_size(view);
        const std::vector<uint> ids = download<uint>(context_.gpu, stack.ids, stack_size);
        std::vector<float> planes;
        if (context_.settings.want.layer == SurfaceLayer::nearest) {
            planes = download<float>(context_.gpu, surfaces_.of_layer(stack),
                                     SURFACE_PLANES * stack_size);
        }
        for (std::size_t i = 0; i < stack_size; ++i) {
            if (ids[i] == 0) continue;
            const std::size_t to = place_behind(last.band.surfaces.view, view, i);
            ++out.layers[to];
            if (!planes.empty()) show_layer(out, to, planes, i);
        }
    });
}

void BandReader::count_evaluated(const LastSample& last, DecodedSurfaces& out) {
    const KernelFeatures& kernels = context_.plan.kernels;
    const RendererKind kind = context_.settings.renderer;
    if (is_forward(kind)) {
        out.evaluated = forward_evaluated(last, out);
    } else if (kind == RendererKind::deferred_all) {
        if (kernels.sampled_shadows) out.variance = download(context_.gpu, last.stages.variance());
        for (std::size_t i = 0; i < plane_size(last.band.surfaces.view); ++i) {
            out.evaluated.push_back(out.planes[i] == 0.0f ? kBackground
                                                          : last.stages.all_lights().count);
        }
    } else {
        const LightCounts counts = count_lights(last);
        out.evaluated =
            download<uint>(context_.gpu, counts.evaluated, plane_size(last.band.surfaces.view));
        out.covering =
            download<uint>(context_.gpu, counts.covering, plane_size(last.band.surfaces.view));
        if (kernels.shadows && !kernels.sampled_shadows) count_seen(last, out);
        out.variance = variance(last);
        if (context_.settings.want.has_aov("error-bound")) out.bound = bound(last);
    }
}

LightCounts BandReader::count_lights(const LastSample& last) {
    if (!count_lights_) {
        count_lights_.emplace(context_.gpu, context_.tuning, context_.plan.kernels);
    }
    StageTimer untimed;
    return count_lights_->enqueue(last.band.lists.at(last.band.surfaces), untimed);
}

std::vector<float> BandReader::overdraw(const Camera& camera, DrawOrder order) {
    if (!overdraw_) overdraw_.emplace(context_.meshes());
    return overdraw_->count(camera, context_.settings.width, context_.settings.height, order);
}

// For forward: lights times the fragments shaded at a pixel.
std::vector<uint> BandReader::forward_evaluated(const LastSample& last,
                                                const DecodedSurfaces& surfaces) {
    const View& view = surfaces.view;
    const HostCoarseLists& lists = last.band.coarse;
    std::vector<uint> out(std::size_t{view.stride} * view.height, kBackground);
    std::vector<float> fragments;
    const bool clustered = !lists.offsets.empty();
    if (!clustered) fragments = overdraw(last.camera, DrawOrder::scene);
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            const std::size_t pixel = y * view.stride + x;
            const std::optional<uint> cluster = coarse_cluster_at(surfaces, pixel);
            if (!cluster) continue;
            out[pixel] = clustered
                             ? lists.offsets[*cluster + 1] - lists.offsets[*cluster]
                             : last.band.lights.count *
                                   static_cast<uint>(std::lround(fragments[y * view.width + x]));
        }
    }
    return out;
}

void BandReader::count_seen(const LastSample& last, DecodedSurfaces& out) {
    const Gpu& gpu = context_.gpu;
    const LitBand& band = last.band;
    if (!count_seen_) count_seen_.emplace(gpu, context_.tuning, context_.plan.kernels);
    StageTimer untimed;
    const SeenCounts counts =
        count_seen_->enqueue(band.lists.at(band.surfaces), band.visible.words, untimed);
    out.facing = download<uint>(gpu, counts.facing, plane_size(band.surfaces.view));
    out.seen = download<uint>(gpu, counts.seen, plane_size(band.surfaces.view));
}

TailErrors& BandReader::tail_errors() {
    if (!tail_errors_) {
        tail_errors_.emplace(context_.gpu, context_.tuning, context_.plan.kernels);
    }
    return *tail_errors_;
}

std::vector<float> BandReader::variance(const LastSample& last) {
    const KernelFeatures& kernels = context_.plan.kernels;
    const LitBand& band = last.band;
    if (!context_.settings.want.has_aov("error-standard")) return {};
    if (kernels.random_ranges == 0.0f) {
        if (kernels.sampled_shadows) return download(context_.gpu, last.stages.variance());
        return std::vector<float>(plane_size(band.surfaces.view));
    }
    StageTimer untimed;
    return download(context_.gpu,
                    tail_errors().variance(band.lists.at(band.surfaces), band.visible.words,
                                           band.visible.samples, last.stages.variance(), untimed));
}

std::vector<float> BandReader::bound(const LastSample& last) {
    StageTimer untimed;
    const LitBand& band = last.band;
    const LitPixels lit = band.lists.at(band.surfaces);
    if (context_.plan.kernels.light_tree) {
        return download(context_.gpu, tail_errors().tree_bound(lit, untimed));
    }
    return download(context_.gpu,
                    tail_errors().bound(lit, band.lights.lights, band.lists.boxes, untimed));
}

std::vector<float> BandReader::illuminance(const LastSample& last) {
    const LitBand& band = last.band;
    const KernelFeatures features = illuminance_features(context_.plan.kernels);
    const auto make = [&](auto& shade) -> auto& {
        if (!shade) {
            shade.emplace(context_.gpu, context_.tuning, features, context_.surface_features());
        }
        return *shade;
    };
    StageTimer untimed;
    const Radiance light =
        last.stages.lists() != nullptr
            ? make(illuminance_)
                  .enqueue(band.lists.at(band.surfaces), untimed,
                           {band.visible.words, band.visible.samples, band.shadows})
            : make(illuminance_of_all_)
                  .enqueue(band.surfaces, last.stages.all_lights(), untimed, band.shadows);
    return download(context_.gpu, light.planes, light.floats());
}

LitSurfaces BandReader::lit_surfaces(const LastSample& last) {
    if (is_forward(context_.settings.renderer)) {
        throw Error("renderer: the forward renderers keep no G-buffer to look at");
    }
    const Gpu& gpu = context_.gpu;
    const PreparedLights& lights =
        last.stages.lists() ? last.band.lists.lights : last.stages.all_lights();
    const auto nodes = download(gpu, lights.nodes, lights.node_count);
    LitSurfaces out{pixels(last),
                    single_lights(download(gpu, lights.lights, lights.rows()), lights.count, nodes),
                    download(gpu, lights.directional, lights.directional_count),
                    {},
                    {}};
    if (lights.extras.shapes) {
        out.shapes =
            single_lights(download(gpu, *lights.extras.shapes, lights.rows()), lights.count, nodes);
    }
    if (lights.extras.profiles) {
        const auto rows = download(gpu, *lights.extras.profiles, lights.rows());
        out.webs = webs_in_view(single_lights(rows, lights.count, nodes), context_.scene->scene());
    }
    return out;
}

}  // namespace kilolux
