// SPDX-License-Identifier: Apache-2.0
// Looking into clusters with the mouse: the pixel under it, and the frozen boxes.
#include <imgui.h>

#include <algorithm>

#include "present/window/app/session.h"
#include "present/window/app/worker_results.h"

namespace kilolux {

ScreenPlace ViewSession::picture_place() const {
    const auto size = window_.size();
    return {panel_width(), 0.0f, static_cast<float>(size[0]), static_cast<float>(size[1])};
}

// Once for every pixel that the mouse comes to, and again in every new picture.
void ViewSession::ask_probe() {
    if (!state_.probe || !picture_ || probing_) return;
    const ScreenPlace place = picture_place();
    const RenderSettings& drawn = picture_->request.settings;
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
    probing_ = true;
    const Camera camera = picture_->request.camera;
    worker_->post([news = news_, x, y, camera](Renderer& renderer) {
        const RenderSettings& s = renderer.settings();
        std::optional<ProbedPixel> out;
        if (x < s.width && y < s.height) {
            out = ProbedPixel{x, y, s.width, s.height, camera, renderer.probe(x, y), {}};
            const auto shading = static_cast<Shading>(renderer.plan().kernels.shading + 1);
            out->shares = light_shares(out->probe, shading, camera.orthographic);
        }
        const std::lock_guard lock(news->mutex);
        news->probed = std::move(out);
        news->probe_done = true;
    });
}

void ViewSession::take_clusters() {
    const std::lock_guard lock(news_->mutex);
    if (news_->probe_done) {
        probed_ = std::move(news_->probed);
        news_->probe_done = false;
        probing_ = false;
        lively_frames_ = std::max(lively_frames_, 1);
    }
    if (news_->frozen) {
        frozen_ = std::move(news_->frozen);
        news_->frozen.reset();
        freezing_ = false;
        box_lights_ = -1;
        lively_frames_ = std::max(lively_frames_, 1);
    }
}

void ViewSession::describe_clusters() {
    ask_probe();
    if (!state_.frozen) {
        frozen_.reset();
        freezing_ = false;
    } else if (!frozen_ && !freezing_ && picture_) {
        freezing_ = true;
        const Camera camera = picture_->request.camera;
        worker_->post([news = news_, camera](Renderer& renderer) {
            FrozenClusters frozen{camera, renderer.active_clusters()};
            if (frozen.clusters.empty()) {
                throw Error("clusters: only the renderer deferred has active ones to freeze");
            }
            const std::lock_guard lock(news->mutex);
            news->frozen = std::move(frozen);
        });
    }
    show_boxes();
    if (!state_.probe || !probed_ || !picture_) return;
    draw_probe(*ImGui::GetBackgroundDrawList(), *probed_, picture_->request.camera,
               picture_place());
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
    if (!picture_) return;
    const Area area = picture_area();
    boxes_->draw(picture_->request.camera, {area.x, 0, area.width, area.height});
}

void ViewSession::describe_picture() {
    if (buffers_.width() == 0) return;
    const ScreenPlace place = picture_place();
    // Dear ImGui passes names of textures as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto texture = reinterpret_cast<ImTextureID>(std::uintptr_t{buffers_.texture()});
    ImGui::GetBackgroundDrawList()->AddImage(texture, {place.x0, place.y0}, {place.x1, place.y1});
}

}  // namespace kilolux
