// SPDX-License-Identifier: Apache-2.0
#include "present/window/screen/event_queue.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace kilolux {
namespace {

bool is_press(const InputEvent& event) {
    const auto* button = std::get_if<ButtonEvent>(&event);
    return button != nullptr && button->action == GLFW_PRESS;
}

bool is_typed(const InputEvent& event) {
    return std::holds_alternative<KeyEvent>(event) || std::holds_alternative<TextEvent>(event);
}

// Releases are never dropped: a key that is down must come up.
bool asks_for_something(const InputEvent& event) {
    const auto* key = std::get_if<KeyEvent>(&event);
    if (key != nullptr) return key->action != GLFW_RELEASE;
    return is_press(event) || std::holds_alternative<TextEvent>(event) ||
           std::holds_alternative<WheelEvent>(event);
}

}  // namespace

std::vector<InputEvent> EventQueue::take(double busy_seconds) {
    if (busy_seconds > kStaleSeconds) std::erase_if(waiting_, asks_for_something);
    press_frames_ = std::max(press_frames_ - 1, 0);
    bool has_move = false, has_button = false;  // this frame
    const auto waits = [&](const InputEvent& event) {
        if (is_typed(event)) return press_frames_ > 0;
        return std::holds_alternative<ButtonEvent>(event)
                   ? has_move
                   : has_button && std::holds_alternative<MoveEvent>(event);
    };
    std::vector<InputEvent> out;
    while (!waiting_.empty() && !waits(waiting_.front())) {
        const InputEvent event = waiting_.front();
        waiting_.pop_front();
        has_button |= std::holds_alternative<ButtonEvent>(event);
        has_move |= std::holds_alternative<MoveEvent>(event);
        if (is_press(event)) press_frames_ = kPressFrames;
        out.push_back(event);
    }
    return out;
}

}  // namespace kilolux
