// SPDX-License-Identifier: Apache-2.0
#include "host/render/read/probe_reader.h"

#include <algorithm>

#include "host/render/lights/light_source.h"

namespace kilolux {
namespace {

SurfaceValues surface_values(const Gpu& gpu, const cl::Buffer& planes, std::size_t plane_size,
                             std::size_t pixel) {
    SurfaceValues out{};
    for (std::size_t i = 0; i < SURFACE_PLANES; ++i) {
        out[i] = download<float>(gpu, planes, 1, i * plane_size + pixel).front();
    }
    return out;
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

PixelProbe ProbeReader::probe(const LastSample& last, const LightRows& rows, int x, int y) {
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
PixelProbe ProbeReader::surface_at(const LitBand& band, int x, int y) {
    const ClusterGrid& grid = band.grid;
    const cl::Buffer planes = surfaces_.of_band(band);
    const std::size_t pixel =
        static_cast<std::size_t>(y) * band.surfaces.view.stride + static_cast<std::size_t>(x);
    PixelProbe out;
    out.grid = grid;
    out.unlit = context_.plan.gbuffer.unlit;
    out.surface = surface_values(context_.gpu, planes, plane_size(band.surfaces.view), pixel);
    out.tile_x = static_cast<uint>(x) / grid.tile_width;
    out.tile_y = static_cast<uint>(y) / grid.tile_height;
    out.slice = slice_of_depth(grid, out.surface[SURFACE_DEPTH]);
    return out;
}

// From near to far.
void ProbeReader::probe_layers(const LastSample& last, uint x, uint y, PixelProbe& out) {
    const Scene& scene = context_.scene->scene();
    const View& behind = last.band.surfaces.view;
    surfaces_.each_layer(last, [&](const LayerStack& stack) {
        const View& view = stack.surfaces.view;
        const cl::Buffer planes = surfaces_.of_layer(stack);
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
            const std::size_t size = plane_size(view);
            out.layers.insert(out.layers.begin(),
                              {surface_values(context_.gpu, planes, size, *pixel),
                               material_of(scene, mesh).name});
        }
    });
}

// The lists of `deferred` at a pixel, and with shadows which of their lights it sees.
void ProbeReader::probe_lists(const LastSample& last, int x, int y, PixelProbe& out) {
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
std::vector<bool> ProbeReader::seen_lights(const LitBand& band, const ActiveCluster& cluster,
                                           uint x, uint y) {
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
