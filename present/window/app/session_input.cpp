// SPDX-License-Identifier: Apache-2.0
#include <GLFW/glfw3.h>
#include <algorithm>

#include "host/picture/views.h"
#include "present/window/app/session.h"

namespace kilolux {
namespace {

constexpr std::size_t kLeft = GLFW_MOUSE_BUTTON_LEFT;
constexpr std::size_t kRight = GLFW_MOUSE_BUTTON_RIGHT;
constexpr std::size_t kMiddle = GLFW_MOUSE_BUTTON_MIDDLE;

double held(const InputState& input, int plus, int minus) {
    return (input.is_down(plus) ? 1.0 : 0.0) - (input.is_down(minus) ? 1.0 : 0.0);
}

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

CameraInput ViewSession::camera_motion() {
    CameraInput motion;
    if (!gui_.wants_keys() && !input_.is_control_down()) {
        motion.move = {held(input_, GLFW_KEY_D, GLFW_KEY_A), held(input_, GLFW_KEY_E, GLFW_KEY_Q),
                       held(input_, GLFW_KEY_W, GLFW_KEY_S)};
    }
    motion.faster = input_.is_shift_down();
    motion.slower = input_.is_alt_down();
    if (!gui_.wants_mouse()) motion.wheel = input_.wheel();
    if (!dragging_) return motion;
    const double height = std::max(window_.size()[1], 1);
    const glm::dvec2 dragged(input_.motion().x / height, input_.motion().y / height);
    const bool pans = input_.was_button_down(kRight) || input_.was_button_down(kMiddle);
    (state_.camera_mode == CameraMode::orbit && pans ? motion.pan : motion.look) = dragged;
    return motion;
}

void ViewSession::steer() {
    const bool pressed = input_.was_button_down(kLeft) || input_.was_button_down(kRight) ||
                         input_.was_button_down(kMiddle);
    const bool begins = pressed && !dragging_ && !gui_.wants_mouse();
    if (begins) dragging_ = true;
    // While the camera flies, the screen's edges do not stop the mouse.
    if (begins && !script_ && state_.camera_mode == CameraMode::fly) window_.grab_mouse(true);
    rig_.move(camera_motion(), state_.camera_mode, clock_.frame_seconds());
    if (dragging_ && !pressed) {
        dragging_ = false;
        if (!script_) window_.grab_mouse(false);
    }
}

void ViewSession::obey_input() {
    steer();
    if (gui_.wants_keys()) return;
    for (const KeyEvent& key : input_.pressed()) obey_key(key);
}

void ViewSession::obey_key(const KeyEvent& key) {
    if (key.key >= GLFW_KEY_1 && key.key <= GLFW_KEY_4) {
        state_.settings.renderer = static_cast<RendererKind>(key.key - GLFW_KEY_1);
    }
    Actions actions;
    for (const KeyBinding& binding : kBindings) {
        const bool held = (key.modifiers & (kShift | kControl)) == binding.modifiers;
        if (binding.key == key.key && held) binding.act(state_, actions);
    }
    obey_actions(actions);
}

}  // namespace kilolux
