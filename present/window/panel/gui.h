// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

#include <optional>

#include "present/window/screen/input.h"
#include "present/window/screen/window.h"

namespace kilolux {

/// A window at a place that the program chooses.
inline constexpr ImGuiWindowFlags kPinned =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;

/// Dear ImGui in a window: its context, fonts and look, fed with the window's events.
class Gui {
 public:
    /// The window's context is current, and outlives this.
    explicit Gui(const Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    void take(const InputEvent& event);

    /// Begins a frame with the mouse of `input`. `seconds` since the last frame; none: by the
    /// clock.
    void begin(const InputState& input, std::optional<double> seconds);

    /// Draws the widgets described since begin() to the current framebuffer.
    void draw();
    /// Ends the frame without drawing, while the window is not visible.
    void skip();

    /// Whether the mouse is on a panel, and whether keys belong to a text field.
    bool wants_mouse() const;
    bool wants_keys() const;

    /// A length for a font of 15 pixels, on this screen.
    float scaled(float pixels) const { return scale_ * pixels; }

 private:
    const Window& window_;
    float scale_;
};

}  // namespace kilolux
