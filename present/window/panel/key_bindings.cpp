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

// The action of a key, with Shift, Ctrl, both or none held, as `modifiers` says.
struct KeyBinding {
    int key;
    int modifiers;
    void (*act)(ViewState& state, Actions& actions);
};

constexpr int kShift = GLFW_MOD_SHIFT;
constexpr int kControl = GLFW_MOD_CONTROL;

// overlay/floating.cpp lists them for the reader.
constexpr KeyBinding kBindings[] = {
    {GLFW_KEY_F1, 0, [](ViewState&, Actions& a) { a.help = true; }},
    {GLFW_KEY_H, 0, [](ViewState&, Actions& a) { a.help = true; }},
    {GLFW_KEY_ESCAPE, 0, [](ViewState&, Actions& a) { a.close_help = true; }},
    {GLFW_KEY_TAB, 0, [](ViewState& s, Actions&) { s.show_panel = !s.show_panel; }},
    {GLFW_KEY_F, 0, [](ViewState&, Actions& a) { a.frame_scene = true; }},
    {GLFW_KEY_R, 0, [](ViewState&, Actions& a) { a.reset_camera = true; }},
    {GLFW_KEY_O, 0, [](ViewState& s, Actions&) { s.camera_mode = opposite(s.camera_mode); }},
    {GLFW_KEY_C, 0, [](ViewState&, Actions& a) { a.copy_command = true; }},
    {GLFW_KEY_C, kControl, [](ViewState&, Actions& a) { a.copy_camera = true; }},
    {GLFW_KEY_V, 0, [](ViewState& s, Actions&) { step_view(s, 1); }},
    {GLFW_KEY_V, kShift, [](ViewState& s, Actions&) { step_view(s, -1); }},
    {GLFW_KEY_L, 0, [](ViewState& s, Actions&) { s.settings.want.view = ViewKind::lit; }},
    {GLFW_KEY_SPACE, 0, [](ViewState& s, Actions&) { s.lights_move = !s.lights_move; }},
    {GLFW_KEY_X, 0, [](ViewState& s, Actions&) { s.probe = !s.probe; }},
    {GLFW_KEY_G, 0, [](ViewState& s, Actions&) { s.frozen = !s.frozen; }},
    {GLFW_KEY_F11, 0, [](ViewState&, Actions& a) { a.full_screen = true; }},
    {GLFW_KEY_P, 0, [](ViewState&, Actions& a) { a.save_png = true; }},
    {GLFW_KEY_P, kShift, [](ViewState&, Actions& a) { a.save_exr = true; }},
    {GLFW_KEY_Q, kControl, [](ViewState&, Actions& a) { a.close = true; }},
};

}  // namespace

Actions obey_key(const KeyEvent& key, ViewState& state) {
    if (key.key >= GLFW_KEY_1 && key.key <= GLFW_KEY_4) {
        state.settings.renderer = static_cast<RendererKind>(key.key - GLFW_KEY_1);
    }
    Actions actions;
    for (const KeyBinding& binding : kBindings) {
        const bool held = (key.modifiers & (kShift | kControl)) == binding.modifiers;
        if (binding.key == key.key && held) binding.act(state, actions);
    }
    return actions;
}

}  // namespace kilolux
