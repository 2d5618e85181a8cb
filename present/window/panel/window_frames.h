// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>

#include "present/window/panel/gui.h"
#include "present/window/panel/widgets.h"
#include "present/window/screen/event_queue.h"
#include "present/window/screen/frame_clock.h"
#include "present/window/screen/screen.h"

namespace kilolux {

/// The frames of a screen: their time, their input, and how they are drawn.
class WindowFrames {
 public:
    /// The screen's context is current. `fixed_seconds`: the length of every frame, for scripts;
    /// none: frames are measured, and input that has waited too long is dropped.
    WindowFrames(Screen& screen, std::optional<double> fixed_seconds);
    ~WindowFrames();

    /// Begins a frame: waits up to `seconds` for an event, calls `then`, and takes the input.
    void begin(double seconds, const std::function<void()>& then);
    /// Ends the frame, and its input.
    void end() { input_.end_frame(); }

    /// Draws the next frames, too.
    void redraw_soon(int frames = 2);
    /// Ends the wait of begin(), from any thread, and has its frame drawn.
    void wake();
    bool is_drawn_soon() const { return frames_to_draw_ > 0; }
    bool has_events() const { return !events_.empty(); }

    /// Begins Dear ImGui's frame, to which widgets are added and which paint() draws.
    void begin_description();
    void paint(bool vsync);
    /// Writes what was described. Throws UsageError for a format of linear pictures.
    void save(const std::filesystem::path& file);

    Screen& screen() const { return screen_; }
    const InputState& input() const { return input_; }
    const FrameClock& clock() const { return clock_; }
    const Gui& gui() const { return gui_; }
    Widgets& ui() { return ui_; }

 private:
    void draw();

    Screen& screen_;
    std::optional<double> fixed_seconds_;
    FrameClock clock_;
    EventQueue events_;
    InputState input_;
    Gui gui_;
    Widgets ui_;
    int frames_to_draw_ = 4;
    std::atomic<bool> woken_ = false;
};

}  // namespace kilolux
