// SPDX-License-Identifier: Apache-2.0
#include "host/picture/frame_bands.h"

#include <algorithm>

namespace kilolux {
namespace {

// Planes of view.stride * band height into planes of view.stride * picture height.
template <typename T>
void place_planes(std::vector<T>& whole, const std::vector<T>& band, const View& view,
                  std::size_t height) {
    const std::size_t rows = std::size_t{view.stride} * view.height;
    if (band.empty()) return;
    const std::size_t planes = band.size() / rows;
    const std::size_t plane = view.stride * height;
    whole.resize(planes * plane);
    for (std::size_t p = 0; p < planes; ++p) {
        std::copy_n(band.begin() + static_cast<std::ptrdiff_t>(p * rows), rows,
                    whole.begin() + static_cast<std::ptrdiff_t>(
                                        p * plane + std::size_t{view.first_row} * view.stride));
    }
}

// The rows from element `first` on, of `size`.
template <typename T>
void place_rows(std::vector<T>& whole, std::vector<T>&& rows, std::size_t first, std::size_t size) {
    if (rows.size() == size) {
        whole = std::move(rows);
        return;
    }
    if (rows.empty()) return;
    whole.resize(size);
    std::ranges::copy(rows, whole.begin() + static_cast<std::ptrdiff_t>(first));
}

// Mean over the pixels with a surface so far; below 0 is "not counted".
double mean_of(double whole, double whole_pixels, double band, double band_pixels) {
    if (whole_pixels + band_pixels <= 0.0 || band < 0.0) return band;
    return (whole * whole_pixels + band * band_pixels) / (whole_pixels + band_pixels);
}

void add_samples(SampleCounts& whole, const SampleCounts& band) {
    whole.least = whole.total == 0 ? band.least : std::min(whole.least, band.least);
    whole.most = std::max(whole.most, band.most);
    whole.total += band.total;
    whole.pixels += band.pixels;
    whole.tiles += band.tiles;
    whole.open_tiles += band.open_tiles;
}

}  // namespace

void place_layers(std::vector<Layer>& whole, std::vector<Layer>&& band, std::size_t first,
                  std::size_t pixels) {
    if (whole.empty()) {
        for (const Layer& layer : band) {
            whole.push_back(
                {.name = layer.name, .channels = layer.channels, .most_id = layer.most_id});
        }
    }
    for (std::size_t i = 0; i < band.size(); ++i) {
        const std::size_t channels = band[i].channels.size();
        place_rows(whole[i].values, std::move(band[i].values), first * channels, pixels * channels);
        place_rows(whole[i].ids, std::move(band[i].ids), first * channels, pixels * channels);
    }
}

void place_surfaces(DecodedSurfaces& whole, DecodedSurfaces&& band, int height) {
    if (static_cast<int>(band.view.height) == height) {
        whole = std::move(band);
        return;
    }
    const auto rows = static_cast<std::size_t>(height);
    using S = DecodedSurfaces;
    for (const auto values : {&S::planes, &S::variance, &S::bound, &S::illuminance}) {
        place_planes(whole.*values, band.*values, band.view, rows);
    }
    for (const auto counts :
         {&S::evaluated, &S::covering, &S::facing, &S::seen, &S::layers, &S::taken}) {
        place_planes(whole.*counts, band.*counts, band.view, rows);
    }
    whole.view = band.view;
    whole.view.first_row = 0;
    whole.view.height = static_cast<uint>(height);
    whole.grid = band.grid;
    whole.unlit = band.unlit;
}

void add_band(FrameStats& whole, const FrameStats& band) {
    const auto above = static_cast<double>(whole.surface_pixels);
    const auto here = static_cast<double>(band.surface_pixels);
    whole.evaluations_per_pixel =
        mean_of(whole.evaluations_per_pixel, above, band.evaluations_per_pixel, here);
    whole.useful_evaluations_per_pixel =
        mean_of(whole.useful_evaluations_per_pixel, above, band.useful_evaluations_per_pixel, here);
    std::copy_n(band.grid, 3, whole.grid);
    using S = FrameStats;
    for (const auto count : {&S::coarse_pairs, &S::active_clusters, &S::refine_tests,
                             &S::refined_pairs, &S::surface_pixels, &S::evaluations}) {
        whole.*count += band.*count;
    }
    for (const auto count : {&S::triangles, &S::triangle_pairs, &S::seen_triangles, &S::texels,
                             &S::layer_pixels, &S::layer_tiles}) {
        whole.*count += band.*count;
    }
    whole.layers = std::max(whole.layers, band.layers);
    whole.build_ms += band.build_ms;
    whole.shadow_scenes_built += band.shadow_scenes_built;
    whole.shadows = whole.shadows + band.shadows;
    add_samples(whole.samples, band.samples);
    whole.shaded_display = band.shaded_display;
    for (const StageTime& stage : band.stages) add_stage_time(whole.stages, stage.name, stage.ms);
}

void add_rows(FrameStats& whole, const FrameStats& rows) {
    add_band(whole, rows);
    whole.lights_uploaded += rows.lights_uploaded;
    whole.frame_ms += rows.frame_ms;
}

FrameStats joined(const std::vector<FrameStats>& parts) {
    const auto slowest = std::ranges::max_element(parts, {}, &FrameStats::frame_ms);
    FrameStats out = *slowest;
    for (auto part = parts.begin(); part != parts.end(); ++part) {
        if (part != slowest) add_rows(out, *part);
    }
    out.stages = slowest->stages;
    out.frame_ms = slowest->frame_ms;
    out.build_ms = slowest->build_ms;
    return out;
}

}  // namespace kilolux
