// SPDX-License-Identifier: Apache-2.0
#include "host/render/band_reader.h"

#include <algorithm>
#include <cmath>

#include "host/render/lights/light_source.h"

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

// Pixels of the band's planes.
std::size_t plane_size(const LitBand& band) {
    return std::size_t{band.surfaces.view.stride} * band.surfaces.view.height;
}

SurfaceValues surface_values(const Gpu& gpu, const cl::Buffer& planes, std::size_t plane_size,
                             std::size_t pixel) {
    SurfaceValues out{};
    for (std::size_t i = 0; i < SURFACE_PLANES; ++i) {
        out[i] = download<float>(gpu, planes, 1, i * plane_size + pixel).front();
    }
    return out;
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

// Adds to a probe what is known of its lights. `rows`: all lights.
void add_lights(const RenderContext& context, const Camera& camera, const LightRows& rows,
                PixelProbe& probe) {
    const RenderSettings& settings = context.settings;
    const View view = view_of(camera, settings.width, settings.height);
    for (ProbedLight& light : probe.lights) {
        light.light = rows.local.at(light.index);
        light.shade = shade_light(view, light.light, light.index, tail_seed(settings, 0));
        if (!rows.shapes.empty()) {
            light.shape = shape_in_view(view, rows.shapes.at(light.index));
        }
        if (rows.profiles.empty()) continue;
        AimedProfile row = rows.profiles.at(light.index);
        row = aimed_in_view(view, row);
        light.web = webs_in_view(std::span(&row, 1), context.scene->scene()).front();
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
        stats.useful_evaluations_per_pixel = mean_over_surfaces(
            download<uint>(context_.gpu, count_lights(last).covering, plane_size(last.band)));
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
    StageTimer untimed;
    DecodedSurfaces out;
    out.view = band.surfaces.view;
    out.grid = band.grid;
    out.unlit = context_.plan.gbuffer.unlit;
    out.planes = download<float>(context_.gpu, decoder().enqueue(band.surfaces, untimed),
                                 SURFACE_PLANES * plane_size(band));
    count_evaluated(last, out);
    if (context_.settings.want.layers()) add_layers(last, out);
    if (context_.settings.want.illuminance()) out.illuminance = illuminance(last);
    if (band.light.groups > 0) {
        out.light = download(context_.gpu, band.light.planes, band.light.floats());
    }
    return out;
}

void BandReader::each_layer(const LastSample& last,
                            const std::function<void(const LayerStack&)>& visit) {
    if (!context_.blends()) return;
    const View& view = last.band.surfaces.view;
    const Band rows{static_cast<int>(view.first_row), static_cast<int>(view.height)};
    last.stages.layer_surfaces().each(context_.device_surfaces(),
                                      crop(last.camera, context_.settings.height, rows),
                                      last.band.surfaces, visit);
}

// Counts the layers, and with SurfaceLayer::nearest puts their surfaces in place of those behind.
void BandReader::add_layers(const LastSample& last, DecodedSurfaces& out) {
    const std::size_t size = plane_size(last.band);
    out.layers.assign(size, 0);
    each_layer(last, [&](const LayerStack& stack) {
        const View& view = stack.surfaces.view;
        const std::size_t stack_size = std::size_t{view.stride} * view.height;
        const std::vector<uint> ids = download<uint>(context_.gpu, stack.ids, stack_size);
        std::vector<float> planes;
        if (context_.settings.want.layer == SurfaceLayer::nearest) {
            StageTimer untimed;
            planes = download<float>(context_.gpu, layer_decoder().enqueue(stack.surfaces, untimed),
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
        for (std::size_t i = 0; i < plane_size(last.band); ++i) {
            out.evaluated.push_back(out.planes[i] == 0.0f ? kBackground
                                                          : last.stages.all_lights().count);
        }
    } else {
        const LightCounts counts = count_lights(last);
        out.evaluated = download<uint>(context_.gpu, counts.evaluated, plane_size(last.band));
        out.covering = download<uint>(context_.gpu, counts.covering, plane_size(last.band));
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
    out.facing = download<uint>(gpu, counts.facing, plane_size(band));
    out.seen = download<uint>(gpu, counts.seen, plane_size(band));
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
        return std::vector<float>(plane_size(band));
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

PixelProbe BandReader::probe(const LastSample& last, const LightRows& rows, int x, int y) {
    last.stages.draw_missing_surfaces(last.camera, last.band);
    const LitBand& band = last.band;
    PixelProbe out = surface_at(band, x, y);
    probe_layers(last, static_cast<uint>(x), static_cast<uint>(y), out);
    if (!out.has_surface()) return out;
    if (last.stages.lists()) {
        probe_lists(last, x, y, out);
    } else if (!band.coarse.offsets.empty()) {
        const uint cluster = cluster_index(band.grid, out.tile_x, out.tile_y, out.slice);
        out.has_list = true;
        for (uint i = band.coarse.offsets[cluster]; i < band.coarse.offsets[cluster + 1]; ++i) {
            out.lights.push_back({.index = band.coarse.lists[i]});
        }
        out.coarse_count = static_cast<uint>(out.lights.size());
    }
    add_lights(context_, last.camera, rows, out);
    return out;
}

// The surface and the coarse cluster of a pixel.
PixelProbe BandReader::surface_at(const LitBand& band, int x, int y) {
    StageTimer untimed;
    const ClusterGrid& grid = band.grid;
    const cl::Buffer planes = decoder().enqueue(band.surfaces, untimed);
    const std::size_t pixel =
        static_cast<std::size_t>(y) * band.surfaces.view.stride + static_cast<std::size_t>(x);
    PixelProbe out;
    out.grid = grid;
    out.unlit = context_.plan.gbuffer.unlit;
    out.surface = surface_values(context_.gpu, planes, plane_size(band), pixel);
    out.tile_x = static_cast<uint>(x) / grid.tile_width;
    out.tile_y = static_cast<uint>(y) / grid.tile_height;
    out.slice = slice_of_depth(grid, out.surface[SURFACE_DEPTH]);
    return out;
}

// From near to far.
void BandReader::probe_layers(const LastSample& last, uint x, uint y, PixelProbe& out) {
    const Scene& scene = context_.scene->scene();
    const View& behind = last.band.surfaces.view;
    each_layer(last, [&](const LayerStack& stack) {
        const View& view = stack.surfaces.view;
        StageTimer untimed;
        const cl::Buffer planes = layer_decoder().enqueue(stack.surfaces, untimed);
        for (std::size_t layer = 0; layer < stack.pixel_counts.size(); ++layer) {
            const auto pixel =
                stack.place(layer, picture_column(behind, x), picture_row(behind, y));
            if (!pixel) return;
            const uint id = download<uint>(context_.gpu, stack.ids, 1, *pixel).front();
            if (id == 0) continue;
            const auto draw =
                std::ranges::upper_bound(stack.draws, id - 1, {},
                                         [](const Draw& d) { return d.row.first_triangle; }) -
                1;
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(draw->mesh)];
            const std::size_t size = std::size_t{view.stride} * view.height;
            out.layers.insert(out.layers.begin(),
                              {surface_values(context_.gpu, planes, size, *pixel),
                               material_of(scene, mesh).name});
        }
    });
}

DecodeGBuffer& BandReader::layer_decoder() {
    if (!decode_layers_) {
        decode_layers_.emplace(context_.gpu, context_.tuning, layer_plan(context_).kernels);
    }
    return *decode_layers_;
}

DecodeGBuffer& BandReader::decoder() {
    if (!decode_) decode_.emplace(context_.gpu, context_.tuning, context_.plan.kernels);
    return *decode_;
}

// The lists of `deferred` at a pixel, and with shadows which of their lights it sees.
void BandReader::probe_lists(const LastSample& last, int x, int y, PixelProbe& out) {
    const LitBand& band = last.band;
    const auto column = static_cast<uint>(x), row = static_cast<uint>(y);
    PixelLists found = last.stages.lists()->at_pixel(band.lists, band.surfaces.view, column, row,
                                                     out.surface[SURFACE_DEPTH]);
    out.coarse_count = found.coarse_count;
    out.active = found.active;
    out.has_list = found.active.has_value();
    for (const uint light : found.lights) out.lights.push_back({.index = light});
    const KernelFeatures& kernels = context_.plan.kernels;
    if (!kernels.shadows || kernels.sampled_shadows || !found.active) return;
    const std::vector<bool> seen = seen_lights(band, *found.active, column, row);
    for (std::size_t i = 0; i < out.lights.size(); ++i) out.lights[i].seen = seen[i];
}

// Of the point and spot lights in the cluster's list, those that pixel (x, y) sees.
std::vector<bool> BandReader::seen_lights(const LitBand& band, const ActiveCluster& cluster, uint x,
                                          uint y) {
    const Gpu& gpu = context_.gpu;
    const ListedLights& lists = band.lists;
    const uint tile = fine_tile_of(band.surfaces.view, x, y);
    const auto order = download(gpu, lists.clusters.order, cluster.pixel_count,
                                std::size_t{tile} * FINE_TILE_PIXELS + cluster.first_pixel);
    const auto code = static_cast<std::uint8_t>(y % FINE_TILE * FINE_TILE + x % FINE_TILE);
    const auto found = static_cast<uint>(std::ranges::find(order, code) - order.begin());
    const uint place = cluster.first_pixel + found;
    const uint last = cluster.first_pixel + cluster.pixel_count;
    const std::size_t stride = (last + 31) / 32 - cluster.first_pixel / 32;
    const std::size_t directional = lists.lights.directional_count;
    const auto offset = download(gpu, band.visible.words.offsets, 1, tile).front();
    const auto words = download(gpu, band.visible.words.words, stride * cluster.list_count,
                                std::size_t{offset} + cluster.first_word + stride * directional);
    std::vector<bool> out;
    for (std::size_t i = 0; i < cluster.list_count; ++i) {
        const uint word = words[i * stride + place / 32 - cluster.first_pixel / 32];
        out.push_back((word >> place % 32 & 1u) != 0);
    }
    return out;
}

}  // namespace kilolux
