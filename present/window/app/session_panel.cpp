// SPDX-License-Identifier: Apache-2.0
// The contents of a frame of the window.
#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>

#include "present/cli/names.h"
#include "present/window/app/session.h"
#include "present/window/panel/panel_settings.h"
#include "present/window/panel/panel_stats.h"

namespace kilolux {
// The line about a picture that takes long; empty: none.
std::string ViewSession::waiting_line() const {
    const PictureProgress* progress = pictures_.progress();
    if (progress == nullptr) return "";
    return waiting_text(state_.settings.renderer, progress->seconds(), progress->estimate());
}

void ViewSession::describe() {
    gui_.begin(input_, script_ ? std::optional(ScriptPlayer::kFrameSeconds) : std::nullopt);
    ui_.begin_frame();
    Actions actions;
    describe_picture();
    const ShownPicture picture = shown_picture();
    clusters_.ask(*worker_, state_, picture);
    clusters_.describe(state_, picture);
    if (state_.show_panel) describe_panel(actions);
    if (state_.show_overlay) {
        describe_overlay(overlay_lines(), notice_, picture.place, picture.scale);
    }
    if (show_help_) describe_help(picture.place, picture.scale);
    actions.dismiss_failure |= describe_failure(ui_, failure_, picture.place, picture.scale);
    ui_.end_frame();
    obey_actions(actions);
}

void ViewSession::describe_picture() {
    const PictureBuffers& buffers = pictures_.buffers();
    if (buffers.width() == 0) return;
    const ScreenPlace at = place();
    const GLuint map = state_.error_map ? error_.map_of(wanted()) : 0;
    const GLuint name = map != 0 ? map : buffers.texture();
    // Dear ImGui passes names of textures as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto texture = reinterpret_cast<ImTextureID>(std::uintptr_t{name});
    ImGui::GetBackgroundDrawList()->AddImage(texture, {at.x0, at.y0}, {at.x1, at.y1});
}

void ViewSession::describe_panel(Actions& actions) {
    ImGui::SetNextWindowPos({0.0f, 0.0f});
    ImGui::SetNextWindowSize({panel_width(), static_cast<float>(window_.size()[1])});
    ImGui::Begin("panel", nullptr, kPinned);
    ui_.set_label_width(gui_.scaled(104.0f));
    facts_.boxes = clusters_.box_count();
    const PanelSettings settings{{ui_, state_, actions, facts_}};
    const PanelStats stats{settings};
    settings.picture();
    settings.lights();
    stats.speed();
    settings.clusters();
    settings.camera(rig_);
    stats.error();
    settings.window();
    stats.device();
    ImGui::End();
}

std::vector<std::string> ViewSession::overlay_lines() const {
    std::vector<std::string> out;
    const RenderSettings& asked = facts_.displayed;
    if (pictures_.shown() == 0) {
        out.emplace_back("compiling kernels and shaders ...");
    } else {
        const double ms = facts_.history.median_frame_ms();
        out.push_back(fmt::format("{:.1f} ms  {:.0f}/s", ms, 1000.0 / std::max(ms, 1e-3)));
        out.push_back(fmt::format("{} x {} at {:.2f}", asked.width, asked.height, facts_.scale));
        if (asked.samples > 1) {
            out.push_back(fmt::format("{} of {} samples", facts_.samples, asked.samples));
        }
        out.push_back(fmt::format("{}  {} lights", name_of(asked.renderer),
                                  short_count(facts_.stats.lights_used)));
    }
    if (!waiting_.empty()) out.push_back(waiting_);
    if (state_.frozen) {
        out.push_back(fmt::format("frozen: {} clusters", short_count(clusters_.box_count())));
    }
    if (error_.is_open()) {
        out.push_back(fmt::format("error: {:.0f} % measured", 100.0f * error_.share()));
    }
    return out;
}

}  // namespace kilolux
