// SPDX-License-Identifier: Apache-2.0
#include "present/window/screen/input.h"

#include <GLFW/glfw3.h>

namespace kilolux {

void InputState::take(const InputEvent& event) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) take_key(*key);
    if (const auto* button = std::get_if<ButtonEvent>(&event)) take_button(*button);
    if (const auto* wheel = std::get_if<WheelEvent>(&event)) wheel_ += wheel->y;
    if (const auto* move = std::get_if<MoveEvent>(&event)) {
        if (has_mouse_) {
            motion_.x += move->x - mouse_.x;
            motion_.y += move->y - mouse_.y;
        }
        mouse_ = *move;
        has_mouse_ = true;
    }
    const auto* focus = std::get_if<FocusEvent>(&event);
    if (focus != nullptr && !focus->focused) {
        // The window that has the focus now gets the releases of held keys and buttons.
        keys_.clear();
        buttons_.fill(false);
    }
}

bool InputState::is_shift_down() const {
    return is_down(GLFW_KEY_LEFT_SHIFT) || is_down(GLFW_KEY_RIGHT_SHIFT);
}
bool InputState::is_control_down() const {
    return is_down(GLFW_KEY_LEFT_CONTROL) || is_down(GLFW_KEY_RIGHT_CONTROL);
}
bool InputState::is_alt_down() const {
    return is_down(GLFW_KEY_LEFT_ALT) || is_down(GLFW_KEY_RIGHT_ALT);
}

void InputState::take_key(const KeyEvent& event) {
    if (event.action == GLFW_RELEASE) {
        keys_.erase(event.key);
    } else if (event.action == GLFW_PRESS) {
        keys_.insert(event.key);
        pressed_.push_back(event);
    }
}

void InputState::take_button(const ButtonEvent& event) {
    const auto button = static_cast<std::size_t>(event.button);
    if (button >= kButtons) return;
    buttons_[button] = event.action == GLFW_PRESS;
    if (buttons_[button]) clicked_[button] = true;
}

void InputState::end_frame() {
    pressed_.clear();
    clicked_.fill(false);
    motion_ = {};
    wheel_ = 0.0;
}

}  // namespace kilolux
