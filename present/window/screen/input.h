// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <variant>
#include <vector>

namespace kilolux {

// Events of a window. Codes are GLFW's; positions are in window coordinates, from the
// upper left.
struct KeyEvent {
    int key = 0;
    int scancode = 0;
    int action = 0;  // GLFW_PRESS, GLFW_RELEASE, GLFW_REPEAT
    int modifiers = 0;
};
struct TextEvent {
    unsigned code_point = 0;
};
struct ButtonEvent {
    int button = 0;
    int action = 0;
    int modifiers = 0;
};
struct MoveEvent {
    double x = 0.0;
    double y = 0.0;
};
struct WheelEvent {
    double x = 0.0;
    double y = 0.0;
};
struct FocusEvent {
    bool focused = false;
};
struct RedrawEvent {};  // the window was uncovered or has another size
using InputEvent =
    std::variant<KeyEvent, TextEvent, ButtonEvent, MoveEvent, WheelEvent, FocusEvent, RedrawEvent>;

/// Keys and buttons that are down, the mouse's position, and the events since the last frame.
class InputState {
 public:
    static constexpr std::size_t kButtons = 3;  // left, right, middle

    void take(const InputEvent& event);

    /// Forgets the frame's events; keys and buttons stay down.
    void end_frame();

    bool is_down(int key) const { return keys_.contains(key); }
    // Either key of the two.
    bool is_shift_down() const;
    bool is_control_down() const;
    bool is_alt_down() const;
    bool is_button_down(std::size_t button) const { return buttons_.at(button); }
    /// Down now, or pressed and released since the last frame.
    bool was_button_down(std::size_t button) const {
        return buttons_.at(button) || clicked_.at(button);
    }
    const std::vector<KeyEvent>& pressed() const { return pressed_; }
    MoveEvent mouse() const { return mouse_; }
    MoveEvent motion() const { return motion_; }
    double wheel() const { return wheel_; }

 private:
    void take_key(const KeyEvent& event);
    void take_button(const ButtonEvent& event);

    std::set<int> keys_;
    std::array<bool, kButtons> buttons_{};
    std::array<bool, kButtons> clicked_{};
    std::vector<KeyEvent> pressed_;  // in their order, without repetitions
    MoveEvent mouse_;
    MoveEvent motion_;  // sum since the last frame
    double wheel_ = 0.0;
    bool has_mouse_ = false;
};

}  // namespace kilolux
