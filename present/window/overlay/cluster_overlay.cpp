// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/cluster_overlay.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/measure/reference/decoded_samples.h"

namespace kilolux {
namespace {

std::optional<ProbedPixel> probe_pixel(Renderer& renderer, const PictureRequest& asked,
                                       const glm::ivec2& at) {
    const RenderSettings& s = renderer.settings();
    // The renderer may have made another picture since, e.g. for a measurement of errors.
    if (s.width != asked.settings.width || s.height != asked.settings.height) return std::nullopt;
    ProbedPixel out{at.x, at.y, s.width, s.height, asked.camera, renderer.probe(at.x, at.y), {}};
    out.shares = light_contributions(out.probe, reference_options(renderer, asked.camera, false));
    return out;
}

FrozenClusters freeze(Renderer& renderer, const Camera& camera) {
    FrozenClusters frozen{camera, renderer.active_clusters()};
    if (frozen.clusters.empty()) {
        throw Error("clusters: only the renderer deferred has active ones to freeze");
    }
    return frozen;
}

}  // namespace

// Asks once for each pixel under the mouse and each picture.
void ClusterOverlay::ask_probe(RenderWorker& worker, const ShownPicture& picture) {
    if (!picture.mouse) {
        probed_.reset();
        probed_for_.fill(-1);
        return;
    }
    const ScreenPlace& place = picture.place;
    const RenderSettings& asked = picture.displayed->settings;
    const glm::dvec2 edges(std::max(place.x1 - place.x0, 1.0f),
                           std::max(place.y1 - place.y0, 1.0f));
    const glm::dvec2 part = (*picture.mouse - glm::dvec2(place.x0, place.y0)) / edges;
    const glm::ivec2 at = glm::clamp(glm::ivec2(part * glm::dvec2(asked.width, asked.height)),
                                     glm::ivec2(0), glm::ivec2(asked.width, asked.height) - 1);
    const std::array<std::int64_t, 3> wanted_for = {at.x, at.y,
                                                    static_cast<std::int64_t>(picture.number)};
    if (std::exchange(probed_for_, wanted_for) == wanted_for) return;
    probing_ = Awaited(worker.ask([at, asked = *picture.displayed](Renderer& renderer) {
        return probe_pixel(renderer, asked, at);
    }));
}

void ClusterOverlay::ask(RenderWorker& worker, const ViewState& state,
                         const ShownPicture& picture) {
    if (!state.frozen) frozen_.reset();
    if (!picture.displayed) return;
    if (state.probe && !probing_.is_open()) ask_probe(worker, picture);
    if (!state.frozen || frozen_ || freezing_.is_open()) return;
    freezing_ = Awaited(worker.ask([camera = picture.displayed->camera](Renderer& renderer) {
        return freeze(renderer, camera);
    }));
}

void ClusterOverlay::take(ViewState& state, const OnFailure& failed) {
    state.probe &= probing_.take(
        [this](std::optional<ProbedPixel> pixel) { probed_ = std::move(pixel); }, failed);
    state.frozen &= freezing_.take(
        [this](FrozenClusters clusters) {
            frozen_ = std::move(clusters);
            box_lights_ = -1;
        },
        failed);
}

void ClusterOverlay::take_depths(const Frame& frame) {
    if (!boxes_ || frame.aovs.empty()) return;
    boxes_->set_depths(frame.aovs.front().values, frame.width, frame.height);
}

void ClusterOverlay::describe(const ViewState& state, const ShownPicture& picture) {
    if (!picture.displayed) return;
    if (frozen_) describe_boxes(state, picture);
    if (!state.probe || !probed_) return;
    draw_probe(*ImGui::GetBackgroundDrawList(), *probed_, picture.displayed->camera, picture.place);
    describe_probe(*probed_, picture.place, picture.scale);
}

void ClusterOverlay::describe_boxes(const ViewState& state, const ShownPicture& picture) {
    if (!boxes_) boxes_ = std::make_unique<BoxPass>();
    if (std::exchange(box_lights_, state.box_lights) != state.box_lights) {
        boxes_->set_boxes(boxes_of(*frozen_, static_cast<uint>(box_lights_)), frozen_->camera);
    }
    box_camera_ = picture.displayed->camera;
    box_area_ = picture.area;
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddCallback(
        [](const ImDrawList*, const ImDrawCmd* command) {
            static_cast<const ClusterOverlay*>(command->UserCallbackData)->paint_boxes();
        },
        this);
    draw.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
    describe_box_colors(longest_list(*frozen_), picture.place, picture.scale);
}

void ClusterOverlay::paint_boxes() const { boxes_->draw(box_camera_, box_area_); }

}  // namespace kilolux
