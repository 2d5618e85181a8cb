// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "present/window/screen/input.h"

namespace kilolux {

/// Events between the window system and the session, in their order.
class EventQueue {
 public:
    /// Input that has waited this long is dropped [s]: the user meant it for another picture.
    static constexpr double kStaleSeconds = 0.5;
    /// Frames that a press of the mouse needs until the widget under it takes the keys.
    static constexpr int kPressFrames = 2;

    void post(const InputEvent& event) { waiting_.push_back(event); }

    /// The events of this frame. Buttons of the mouse and its moves are in different frames, so
    /// that the panel sees the mouse where a button went down or up. Keys and text after a press,
    /// and later events, wait until the press has had its effect. `busy_seconds`: how long no
    /// events were taken.
    std::vector<InputEvent> take(double busy_seconds);

    bool empty() const { return waiting_.empty(); }

 private:
    std::deque<InputEvent> waiting_;
    int press_frames_ = 0;  // until the last press has had its effect
};

}  // namespace kilolux
