// SPDX-License-Identifier: Apache-2.0
// The picture in the window, and what is drawn over it: the probed pixel's lists, frozen clusters,
// the error map.
#include <imgui.h>

#include <algorithm>

#include "host/base/error.h"
#include "present/window/app/session.h"

namespace kilolux {

ScreenPlace ViewSession::picture_place() const {
    const auto size = window_.size();
    return {panel_width(), 0.0f, static_cast<float>(size[0]), static_cast<float>(size[1])};
}

// Asks once for each pixel under the mouse and each picture.
void ViewSession::ask_probe() {
    if (!state_.probe || !drawn_ || probing_.valid()) return;
    const ScreenPlace place = picture_place();
    const RenderSettings& drawn = drawn_->settings;
    const double u = (input_.mouse().x - static_cast<double>(place.x0)) /
                     std::max(static_cast<double>(place.x1 - place.x0), 1.0);
    const double v = (input_.mouse().y - static_cast<double>(place.y0)) /
                     std::max(static_cast<double>(place.y1 - place.y0), 1.0);
    if (u < 0.0 || u >= 1.0 || v < 0.0 || v >= 1.0 || gui_.wants_mouse()) {
        probed_.reset();
        probed_for_ = {-1, -1, -1};
        return;
    }
    const int x = static_cast<int>(u * drawn.width);
    const int y = static_cast<int>(v * drawn.height);
    const std::array<int, 3> wanted_for = {x, y, static_cast<int>(shown_)};
    if (wanted_for == probed_for_) return;
    probed_for_ = wanted_for;
    probing_ = worker_->ask([x, y, drawn = *drawn_](Renderer& renderer) {
        const RenderSettings& s = renderer.settings();
        std::optional<ProbedPixel> out;
        // The renderer may have made another picture since, e.g. for a measurement of errors.
        if (s.width != drawn.settings.width || s.height != drawn.settings.height) return out;
        out = ProbedPixel{x, y, s.width, s.height, drawn.camera, renderer.probe(x, y), {}};
        const KernelFeatures& kernels = renderer.plan().kernels;
        out->shares =
            light_contributions(out->probe, {.shading = shading_of(kernels),
                                             .orthographic = drawn.camera.orthographic,
                                             .light_d_min = double{kernels.light_d_min},
                                             .drawn_ranges = double{kernels.drawn_ranges}});
        return out;
    });
}

void ViewSession::ask_clusters() {
    if (!state_.frozen) frozen_.reset();
    if (!state_.frozen || frozen_ || freezing_.valid() || !drawn_) return;
    freezing_ = worker_->ask([camera = drawn_->camera](Renderer& renderer) {
        FrozenClusters frozen{camera, renderer.active_clusters()};
        if (frozen.clusters.empty()) {
            throw Error("clusters: only the renderer deferred has active ones to freeze");
        }
        return frozen;
    });
}

// Switches the probe or the freeze off when its task failed.
void ViewSession::take_clusters() {
    state_.probe &=
        take(probing_, [this](std::optional<ProbedPixel> pixel) { probed_ = std::move(pixel); });
    state_.frozen &= take(freezing_, [this](FrozenClusters clusters) {
        frozen_ = std::move(clusters);
        box_lights_ = -1;
    });
}

void ViewSession::describe_clusters() {
    ask_probe();
    ask_clusters();
    show_boxes();
    if (!state_.probe || !probed_ || !drawn_) return;
    draw_probe(*ImGui::GetBackgroundDrawList(), *probed_, drawn_->camera, picture_place());
    const auto size = window_.size();
    const float margin = gui_.scaled(10.0f);
    describe_probe(*probed_,
                   {static_cast<float>(size[0]) - margin, static_cast<float>(size[1]) - margin},
                   gui_.scaled(1.0f));
}

void ViewSession::show_boxes() {
    if (!frozen_) return;
    if (!boxes_) boxes_ = std::make_unique<BoxPass>();
    if (box_lights_ != state_.box_lights) {
        box_lights_ = state_.box_lights;
        boxes_->set_boxes(boxes_of(*frozen_, static_cast<uint>(box_lights_)), frozen_->camera);
        facts_.boxes = boxes_->box_count();
    }
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddCallback(
        [](const ImDrawList*, const ImDrawCmd* command) {
            static_cast<const ViewSession*>(command->UserCallbackData)->paint_boxes();
        },
        this);
    draw.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
}

void ViewSession::paint_boxes() const {
    if (drawn_) boxes_->draw(drawn_->camera, picture_area());
}

void ViewSession::describe_picture() {
    if (buffers_.width() == 0) return;
    const ScreenPlace place = picture_place();
    const GLuint name = shows_error() ? error_map_.name() : buffers_.texture();
    // Dear ImGui passes names of textures as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto texture = reinterpret_cast<ImTextureID>(std::uintptr_t{name});
    ImGui::GetBackgroundDrawList()->AddImage(texture, {place.x0, place.y0}, {place.x1, place.y1});
}

}  // namespace kilolux
