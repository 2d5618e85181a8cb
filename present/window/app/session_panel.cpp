// SPDX-License-Identifier: Apache-2.0
#include <imgui.h>

#include <algorithm>

#include "present/cli/names.h"
#include "present/window/app/session.h"

namespace kilolux {
namespace {

constexpr ImGuiWindowFlags kPinned = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                     ImGuiWindowFlags_NoSavedSettings;
constexpr ImGuiWindowFlags kFloating = kPinned | ImGuiWindowFlags_NoInputs |
                                       ImGuiWindowFlags_AlwaysAutoResize |
                                       ImGuiWindowFlags_NoFocusOnAppearing;

struct KeyHelp {
    const char* keys;
    const char* meaning;
};

constexpr KeyHelp kKeys[] = {
    {"W A S D  Q E", "fly, or orbit: forward, left, back, right, down, up"},
    {"drag the mouse", "look around; orbit: turn, right or middle button: pan"},
    {"Shift, Alt", "faster, slower"},
    {"mouse wheel", "fly: speed; orbit: distance"},
    {"O", "fly or orbit"},
    {"F, R", "frame the scene; back to the first camera"},
    {"1 2 3 4", "deferred, forward-plus, forward, deferred-all"},
    {"V, Shift+V, L", "next view, previous view, the lit picture"},
    {"Space", "lights move or rest"},
    {"X", "lists of the pixel under the mouse"},
    {"G", "freeze the clusters and fly around them"},
    {"P, Shift+P", "save the picture as PNG, as EXR"},
    {"C, Ctrl+C", "copy the command that renders this; the camera's options"},
    {"Tab", "panel"},
    {"F11", "full screen"},
    {"H or F1", "this help"},
    {"Ctrl+Q", "leave"},
    {"Ctrl+click", "on a slider: type a number"},
};

}  // namespace

void ViewSession::describe() {
    gui_.begin(input_, script_ ? std::optional(ScriptPlayer::kFrameSeconds) : std::nullopt);
    ui_.begin_frame();
    Actions actions;
    describe_picture();
    describe_clusters();
    if (state_.show_panel) describe_panel(actions);
    if (state_.show_overlay) describe_overlay();
    if (show_help_) describe_help();
    describe_failure(actions);
    ui_.end_frame();
    obey_actions(actions);
}

void ViewSession::describe_panel(Actions& actions) {
    ImGui::SetNextWindowPos({0.0f, 0.0f});
    ImGui::SetNextWindowSize({panel_width(), static_cast<float>(window_.size()[1])});
    ImGui::Begin("panel", nullptr, kPinned);
    ui_.set_label_width(gui_.scaled(104.0f));
    const Panel panel{ui_, state_, actions, facts_};
    panel.picture();
    panel.lights();
    panel.speed();
    panel.clusters();
    panel.camera(rig_);
    panel.error();
    panel.window();
    panel.device();
    ImGui::End();
}

void ViewSession::describe_overlay() {
    const float margin = gui_.scaled(10.0f);
    ImGui::SetNextWindowPos({static_cast<float>(window_.size()[0]) - margin, margin},
                            ImGuiCond_Always, {1.0f, 0.0f});
    ImGui::SetNextWindowBgAlpha(0.62f);
    ImGui::Begin("overlay", nullptr, kFloating);
    if (shown_ == 0) {
        ImGui::TextUnformatted("compiling kernels and shaders ...");
    } else {
        const double ms = facts_.history.median_frame_ms();
        ImGui::Text("%.1f ms  %.0f/s", ms, 1000.0 / std::max(ms, 1e-3));
        ImGui::Text("%d x %d at %.2f", facts_.width, facts_.height, facts_.scale);
        if (facts_.all_samples > 1) {
            ImGui::Text("%d of %d samples", facts_.samples, facts_.all_samples);
        }
        ImGui::Text("%s  %s lights", name_of(state_.settings.renderer).c_str(),
                    short_count(facts_.stats.lights_used).c_str());
    }
    if (state_.frozen) ImGui::Text("frozen: %s clusters", short_count(facts_.boxes).c_str());
    if (facts_.measuring) ImGui::Text("error: %.0f %% measured", 100.0 * facts_.error_share);
    if (!facts_.notice.empty()) {
        ImGui::PushTextWrapPos(gui_.scaled(260.0f));
        ImGui::TextColored({1.0f, 1.0f, 1.0f, facts_.notice_alpha}, "%s", facts_.notice.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

void ViewSession::describe_help() {
    const auto size = window_.size();
    ImGui::SetNextWindowPos(
        {0.5f * (panel_width() + static_cast<float>(size[0])), 0.5f * static_cast<float>(size[1])},
        ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(0.92f);
    ImGui::Begin("help", nullptr, kFloating);
    ImGui::TextUnformatted("Keys");
    ImGui::Separator();
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const KeyHelp& entry : kKeys) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextColored({0.95f, 0.72f, 0.34f, 1.0f}, "%s", entry.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(entry.meaning);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void ViewSession::describe_failure(Actions& actions) {
    if (facts_.failure.empty()) return;
    const auto size = window_.size();
    const float middle = 0.5f * (panel_width() + static_cast<float>(size[0]));
    ImGui::SetNextWindowPos({middle, static_cast<float>(size[1]) - gui_.scaled(20.0f)},
                            ImGuiCond_Always, {0.5f, 1.0f});
    ImGui::Begin("failure", nullptr, kPinned | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushTextWrapPos(gui_.scaled(420.0f));
    ImGui::TextColored({1.0f, 0.5f, 0.4f, 1.0f}, "%s", facts_.failure.c_str());
    ImGui::PopTextWrapPos();
    actions.dismiss_failure |= ui_.button("Dismiss");
    ImGui::End();
}

}  // namespace kilolux
