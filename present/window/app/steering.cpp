// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/steering.h"

#include <GLFW/glfw3.h>
#include <algorithm>

namespace kilolux {
namespace {

constexpr std::size_t kLeft = GLFW_MOUSE_BUTTON_LEFT;
constexpr std::size_t kRight = GLFW_MOUSE_BUTTON_RIGHT;
constexpr std::size_t kMiddle = GLFW_MOUSE_BUTTON_MIDDLE;

double held(const InputState& input, int plus, int minus) {
    return (input.is_down(plus) ? 1.0 : 0.0) - (input.is_down(minus) ? 1.0 : 0.0);
}

}  // namespace

CameraInput camera_input(const SteeringInput& from, CameraMode mode) {
    const InputState& input = from.input;
    CameraInput out;
    if (from.has_keys && !input.is_control_down()) {
        out.move = {held(input, GLFW_KEY_D, GLFW_KEY_A), held(input, GLFW_KEY_E, GLFW_KEY_Q),
                    held(input, GLFW_KEY_W, GLFW_KEY_S)};
    }
    out.faster = input.is_shift_down();
    out.slower = input.is_alt_down();
    if (from.has_wheel) out.wheel = input.wheel();
    if (!from.drags) return out;
    const double height = std::max(from.height, 1);
    const glm::dvec2 dragged(input.motion().x / height, input.motion().y / height);
    const bool pans = input.was_button_down(kRight) || input.was_button_down(kMiddle);
    (mode == CameraMode::orbit && pans ? out.pan : out.look) = dragged;
    return out;
}

CameraInput Steering::motion(CameraMode mode) const {
    const Gui& gui = frames_.gui();
    return camera_input({frames_.input(), !gui.wants_keys(), !gui.wants_mouse(), dragging_,
                         frames_.screen().size()[1]},
                        mode);
}

void Steering::steer(CameraMode mode) {
    const InputState& input = frames_.input();
    const bool pressed = input.was_button_down(kLeft) || input.was_button_down(kRight) ||
                         input.was_button_down(kMiddle);
    const bool begins = pressed && !dragging_ && !frames_.gui().wants_mouse();
    if (begins) dragging_ = true;
    if (begins && grabs_ && mode == CameraMode::fly) frames_.screen().grab_mouse(true);
    rig_.move(motion(mode), mode, frames_.clock().frame_seconds());
    if (dragging_ && !pressed) {
        dragging_ = false;
        if (grabs_) frames_.screen().grab_mouse(false);
    }
}

}  // namespace kilolux
