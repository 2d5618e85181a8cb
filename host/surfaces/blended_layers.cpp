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
    const uint column = plane_column(view, x), row = plane_row(view, y);  // wrap if beside
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

// Draws the next layers as a G-buffer.
void BlendedLayers::draw_layers(StageTimer& timer) {
    const LayerIds drawn = raster_.enqueue(stack_.scene, lists_, timer);
    const View& view = drawn.view;
    stack_.ids = drawn.ids;
    stack_.surfaces =
        resolve_.enqueue(stack_.ids, stack_.scene,
                         make_gbuffer_layout(plan_.gbuffer, view.stride, view.height), view, timer);
    is_counted_ = false;
}

void BlendedLayers::count_drawn() {
    RasterLayers::Drawn drawn = raster_.drawn();
    stack_.pixel_counts = std::move(drawn.pixels);
    layers_[first_row_] += stack_.pixel_counts.size();
    goes_on_ = drawn.may_go_on;
    is_counted_ = true;
}

const LayerStack* BlendedLayers::begin(SurfaceScene& on_device, const Camera& camera,
                                       const GBuffer& opaque, StageTimer& timer) {
    if (behind_ != 0 && opaque.version == behind_) return draws_.empty() ? nullptr : &stack_;
    behind_ = opaque.version;
    first_row_ = opaque.view.first_row;
    stack_ = {};  // arrays that grow must not be held twice
    lists_ = {};
    goes_on_ = false;
    is_counted_ = true;
    const View& view = opaque.view;
    draws_ = draw_list_.visible(camera, static_cast<int>(view.width), static_cast<int>(view.height),
                                true, DrawOrder::front_to_back);
    if (draws_.empty()) return nullptr;
    stack_.draws = draws_;
    stack_.scene = on_device.at(draws_);
    const View region = region_of(draws_, view);
    lists_ = bin_.enqueue(stack_.scene, drawn_triangles(draws_, scene_), region, timer);
    // As many as there were the last time, so that most frames need no other stack.
    const auto last = layers_.find(first_row_);
    expected_ = last == layers_.end() ? RasterLayers::kMostLayers : last->second;
    raster_.begin(opaque, region, std::max<std::size_t>(expected_, 1), timer);
    draw_layers(timer);
    if (behind_ != 0) stack_.surfaces.version = ++version_;
    return &stack_;
}

bool BlendedLayers::fits() {
    if (is_counted_) return true;
    if (!bin_.fits(bin_.pairs())) {
        behind_ = 0;
        return false;
    }
    layers_[first_row_] = 0;
    count_drawn();
    return true;
}

const LayerStack* BlendedLayers::next(StageTimer& timer) {
    if (!goes_on_) return nullptr;
    check_interrupt();
    behind_ = 0;
    draw_layers(timer);
    count_drawn();
    return stack_.pixel_counts.empty() ? nullptr : &stack_;
}

void BlendedLayers::each(SurfaceScene& on_device, const Camera& camera, const GBuffer& opaque,
                         const std::function<void(const LayerStack&)>& visit) {
    StageTimer untimed;
    const LayerStack* stack = begin(on_device, camera, opaque, untimed);
    while (!fits()) stack = begin(on_device, camera, opaque, untimed);
    for (; stack; stack = next(untimed)) visit(*stack);
}

}  // namespace kilolux
