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

std::string next_of(const std::vector<std::string>& names, const std::string& now, int step) {
    const auto found = std::find(names.begin(), names.end(), now);
    const int count = static_cast<int>(names.size());
    const int place = static_cast<int>(found - names.begin());
    return names[static_cast<std::size_t>((place + step + count) % count)];
}

}  // namespace

CameraWish ViewSession::camera_wish() {
    CameraWish wish;
    const bool command = input_.is_down(GLFW_KEY_LEFT_CONTROL);
    if (!gui_.wants_keys() && !command) {
        wish.move = {held(input_, GLFW_KEY_D, GLFW_KEY_A), held(input_, GLFW_KEY_E, GLFW_KEY_Q),
                     held(input_, GLFW_KEY_W, GLFW_KEY_S)};
    }
    wish.faster = input_.is_down(GLFW_KEY_LEFT_SHIFT) || input_.is_down(GLFW_KEY_RIGHT_SHIFT);
    wish.slower = input_.is_down(GLFW_KEY_LEFT_ALT) || input_.is_down(GLFW_KEY_RIGHT_ALT);
    if (!gui_.wants_mouse()) wish.wheel = input_.wheel();
    if (!dragging_) return wish;
    const double height = std::max(window_.size()[1], 1);
    const glm::dvec2 dragged(input_.motion().x / height, input_.motion().y / height);
    const bool pans = input_.was_button_down(kRight) || input_.was_button_down(kMiddle);
    (state_.camera_mode == CameraMode::orbit && pans ? wish.pan : wish.look) = dragged;
    return wish;
}

void ViewSession::steer() {
    const bool pressed = input_.was_button_down(kLeft) || input_.was_button_down(kRight) ||
                         input_.was_button_down(kMiddle);
    const bool begins = pressed && !dragging_ && !gui_.wants_mouse();
    if (begins) dragging_ = true;
    // What is flown by the mouse wants room for the mouse.
    if (begins && !script_ && state_.camera_mode == CameraMode::fly) window_.grab_mouse(true);
    rig_.move(camera_wish(), state_.camera_mode, frame_seconds_);
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
    PanelWishes wishes;
    const bool shift = (key.modifiers & GLFW_MOD_SHIFT) != 0;
    const bool control = (key.modifiers & GLFW_MOD_CONTROL) != 0;
    RenderSettings& s = state_.settings;
    switch (key.key) {
        case GLFW_KEY_F1:
        case GLFW_KEY_H:
            wishes.help = true;
            break;
        case GLFW_KEY_ESCAPE:
            show_help_ = false;
            break;
        case GLFW_KEY_TAB:
            state_.show_panel = !state_.show_panel;
            break;
        case GLFW_KEY_F:
            wishes.frame_scene = true;
            break;
        case GLFW_KEY_R:
            wishes.reset_camera = true;
            break;
        case GLFW_KEY_O:
            state_.camera_mode =
                state_.camera_mode == CameraMode::fly ? CameraMode::orbit : CameraMode::fly;
            break;
        case GLFW_KEY_C:
            (control ? wishes.copy_camera : wishes.copy_command) = true;
            break;
        case GLFW_KEY_V:
            s.want.view = parse_view(next_of(view_names(), name_of(s.want.view), shift ? -1 : 1));
            break;
        case GLFW_KEY_L:
            s.want.view = ViewKind::lit;
            break;
        case GLFW_KEY_SPACE:
            state_.lights_move = !state_.lights_move;
            break;
        case GLFW_KEY_X:
            state_.probe = !state_.probe;
            break;
        case GLFW_KEY_G:
            state_.frozen = !state_.frozen;
            break;
        case GLFW_KEY_F11:
            wishes.full_screen = true;
            break;
        case GLFW_KEY_P:
            (shift ? wishes.save_exr : wishes.save_png) = true;
            break;
        default:
            break;
    }
    if (key.key >= GLFW_KEY_1 && key.key <= GLFW_KEY_4) {
        s.renderer = static_cast<RendererKind>(key.key - GLFW_KEY_1);
    }
    if (control && key.key == GLFW_KEY_Q) window_.close();
    obey_wishes(wishes);
}

}  // namespace kilolux
