// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/key_bindings.h"

#include <GLFW/glfw3.h>

#include "host/picture/views.h"

namespace kilolux {
namespace {

CameraMode opposite(CameraMode mode) {
    return mode == CameraMode::fly ? CameraMode::orbit : CameraMode::fly;
}

void step_view(ViewState& state, int step) {
    const int count = static_cast<int>(view_names().size());
    const int now = static_cast<int>(state.settings.want.view);
    state.settings.want.view = static_cast<ViewKind>((now + step + count) % count);
}

template <bool Actions::*action>
void ask(ViewState&, Actions& actions) {
    actions.*action = true;
}

template <bool ViewState::*member>
void toggle(ViewState& state, Actions&) {
    state.*member = !(state.*member);
}

template <RendererKind kind>
void choose_renderer(ViewState& state, Actions&) {
    state.settings.renderer = kind;
}

constexpr int kShift = GLFW_MOD_SHIFT;
constexpr int kControl = GLFW_MOD_CONTROL;
constexpr int kAny = KeyBinding::kAnyModifiers;

constexpr KeyRow kRows[] = {
    {"W A S D  Q E", "fly, or orbit: forward, left, back, right, down, up"},
    {"drag the mouse", "look around; orbit: turn, right or middle button: pan"},
    {"Shift, Alt", "faster, slower"},
    {"mouse wheel", "fly: speed; orbit: distance"},
    {"O",
     "fly or orbit",
     {{{GLFW_KEY_O, 0, [](ViewState& s, Actions&) { s.camera_mode = opposite(s.camera_mode); }}}}},
    {"F, R",
     "frame the scene; back to the first camera",
     {{{GLFW_KEY_F, 0, ask<&Actions::frame_scene>}, {GLFW_KEY_R, 0, ask<&Actions::reset_camera>}}}},
    {"1 2 3 4",
     "deferred, forward-plus, forward, deferred-all",
     {{{GLFW_KEY_1, kAny, choose_renderer<RendererKind::deferred>},
       {GLFW_KEY_2, kAny, choose_renderer<RendererKind::forward_plus>},
       {GLFW_KEY_3, kAny, choose_renderer<RendererKind::forward>},
       {GLFW_KEY_4, kAny, choose_renderer<RendererKind::deferred_all>}}}},
    {"V, Shift+V, L",
     "next view, previous view, the lit picture",
     {{{GLFW_KEY_V, 0, [](ViewState& s, Actions&) { step_view(s, 1); }},
       {GLFW_KEY_V, kShift, [](ViewState& s, Actions&) { step_view(s, -1); }},
       {GLFW_KEY_L, 0, [](ViewState& s, Actions&) { s.settings.want.view = ViewKind::lit; }}}}},
    {"Space", "lights move or rest", {{{GLFW_KEY_SPACE, 0, toggle<&ViewState::lights_move>}}}},
    {"X", "lists of the pixel under the mouse", {{{GLFW_KEY_X, 0, toggle<&ViewState::probe>}}}},
    {"G",
     "freeze the clusters and fly around them",
     {{{GLFW_KEY_G, 0, toggle<&ViewState::frozen>}}}},
    {"P, Shift+P",
     "save the picture as PNG, as EXR",
     {{{GLFW_KEY_P, 0, ask<&Actions::save_png>}, {GLFW_KEY_P, kShift, ask<&Actions::save_exr>}}}},
    {"C, Ctrl+C",
     "copy the command that renders this; the camera's options",
     {{{GLFW_KEY_C, 0, ask<&Actions::copy_command>},
       {GLFW_KEY_C, kControl, ask<&Actions::copy_camera>}}}},
    {"Tab", "panel", {{{GLFW_KEY_TAB, 0, toggle<&ViewState::show_panel>}}}},
    {"F11", "full screen", {{{GLFW_KEY_F11, 0, ask<&Actions::full_screen>}}}},
    {"H or F1",
     "this help",
     {{{GLFW_KEY_H, 0, ask<&Actions::help>},
       {GLFW_KEY_F1, 0, ask<&Actions::help>},
       {GLFW_KEY_ESCAPE, 0, ask<&Actions::close_help>}}}},
    {"Ctrl+Q", "leave", {{{GLFW_KEY_Q, kControl, ask<&Actions::close>}}}},
    {"Ctrl+click", "on a slider: type a number"},
};

}  // namespace

std::span<const KeyRow> key_rows() { return kRows; }

Actions obey_key(const KeyEvent& key, ViewState& state) {
    Actions actions;
    for (const KeyRow& row : kRows) {
        for (const KeyBinding& binding : row.bindings) {
            const bool held = binding.modifiers == kAny ||
                              (key.modifiers & (kShift | kControl)) == binding.modifiers;
            if (binding.act && binding.key == key.key && held) binding.act(state, actions);
        }
    }
    return actions;
}

}  // namespace kilolux
