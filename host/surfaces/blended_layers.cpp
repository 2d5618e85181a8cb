// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/blended_layers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/system/interrupt.h"

namespace kilolux {
namespace {

// The whole tiles of the planes of `view` in which the draws may be seen.
View region_of(std::span<const Draw> draws, const View& view) {
    const glm::dvec2 size(view.width, view.height);
    glm::dvec2 least = size, most(0.0);
    for (const Draw& draw : draws) {
        least = glm::min(least, glm::max(draw.screen.least, 0.0));
        most = glm::max(most, glm::min(draw.screen.most, size));
    }
    const auto first_tile = [](double pixel) {
        return static_cast<uint>(pixel) / FINE_TILE * FINE_TILE;
    };
    const uint column = first_tile(std::min(least.x, size.x - 1.0));
    const uint row = first_tile(std::min(least.y, size.y - 1.0));
    const auto end = [](double pixel, uint first) {
        return std::max(static_cast<uint>(std::ceil(pixel)), first + 1);
    };
    View out = view;
    out.first_column += column;
    out.first_row += row;
    out.width = end(most.x, column) - column;
    out.height = end(most.y, row) - row;
    out.stride = static_cast<uint>(round_up(out.width, FINE_TILE));
    return out;
}

}  // namespace

std::optional<std::size_t> LayerStack::place(std::size_t layer, uint x, uint y) const {
    const View& view = surfaces.view;
    const uint column = x - view.first_column, row = y - view.first_row;  // wrap if beside
    if (column >= view.width || row >= rows_of_layer(view)) return {};
    return (layer * rows_of_layer(view) + row) * view.stride + column;
}

BlendedLayers::BlendedLayers(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                             SurfacePlan plan)
    : scene_(scene),
      plan_(std::move(plan)),
      draw_list_(scene),
      bin_(gpu, tuning),
      raster_(gpu, tuning),
      resolve_(gpu, tuning, plan_.kernels, plan_.surfaces) {}

void BlendedLayers::draw_first(StageTimer& timer) {
    lists_ = {};  // arrays that grow must not be held twice
    drawn_ = {};
    lists_ = bin_.enqueue(on_device_, drawn_triangles(draws_, scene_), region_, timer);
    raster_.begin(opaque_, region_, timer);
    drawn_ = raster_.enqueue(on_device_, lists_, timer);
}

void BlendedLayers::begin(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
                          StageTimer& timer) {
    const View& view = opaque.view;
    draws_ = draw_list_.visible(camera, static_cast<int>(view.width), static_cast<int>(view.height),
                                true, DrawOrder::front_to_back);
    if (draws_.empty()) return;
    opaque_ = opaque;
    on_device_ = on_device.at(draws_);
    region_ = region_of(draws_, view);
    draw_first(timer);
}

void BlendedLayers::each(StageTimer& timer, const std::function<void(const LayerStack&)>& visit) {
    if (draws_.empty()) return;
    while (!bin_.fits(bin_.pairs())) draw_first(timer);
    LayerStack stack;
    stack.draws = draws_;
    stack.scene = on_device_;
    for (bool goes_on = true; goes_on;) {
        check_interrupt();
        const RasterLayers::Drawn drawn = raster_.drawn();
        if (drawn.pixels.empty()) break;
        goes_on = drawn.may_go_on;
        stack.pixels = drawn.pixels;
        const View view = first_layers(drawn_.view, static_cast<uint>(drawn.pixels.size()));
        stack.ids = drawn_.ids;
        stack.surfaces = resolve_.enqueue(
            stack.ids, stack.scene, make_gbuffer_layout(plan_.gbuffer, view.stride, view.height),
            view, timer);
        visit(stack);
        if (goes_on) drawn_ = raster_.enqueue(on_device_, lists_, timer);
    }
    opaque_ = {};
    on_device_ = {};
    lists_ = {};
    drawn_ = {};
}

}  // namespace kilolux
