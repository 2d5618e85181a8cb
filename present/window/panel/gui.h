// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

#include <chrono>
#include <optional>
#include <string>

#include "present/window/screen/screen.h"

namespace kilolux {

/// A window at a place that the program chooses.
inline constexpr ImGuiWindowFlags kPinned =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;

/// Dear ImGui on a screen: its context, fonts and look, fed with the screen's events.
class Gui {
 public:
    /// The session's OpenGL context is current, and outlives this.
    explicit Gui(Screen& screen);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    void take(const InputEvent& event);

    /// Begins a frame with the mouse of `input`. `seconds` since the last frame; none: by the
    /// clock.
    void begin(const InputState& input, std::optional<double> seconds);

    /// Draws the widgets described since begin() to the current framebuffer.
    void draw();
    /// Ends the frame without drawing, while nobody sees the screen.
    void skip();

    /// Whether the mouse is on a panel, and whether keys belong to a text field.
    bool wants_mouse() const;
    bool wants_keys() const;

    /// A length for a font of 15 pixels, on this screen.
    float scaled(float pixels) const { return scale_ * pixels; }

 private:
    void install_callbacks();
    void fit_fonts();

    Screen& screen_;
    float scale_ = 0.0f;     // of fonts and lengths; 0: none are loaded
    std::string clipboard_;  // that was read last
    std::chrono::steady_clock::time_point last_frame_ = std::chrono::steady_clock::now();
};

}  // namespace kilolux
