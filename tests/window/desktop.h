// SPDX-License-Identifier: Apache-2.0
// A virtual display with or without a window manager, and the program's window on it: real keys, a
// real window manager, and the contents of the screen.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/window/background.h"

namespace kilolux {

/// A rectangle of the screen [pixel], from the upper left.
struct Place {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Place&) const = default;
};

/// A rectangle of the screen: red, green, blue of each pixel, by rows.
struct Seen {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
    bool operator==(const Seen&) const = default;
};

/// Number of colours in it.
std::size_t count_colours(const Seen& seen);

class Desktop {
 public:
    /// `options`: with_display's. Throws std::runtime_error that says what is missing.
    explicit Desktop(const std::vector<std::string>& options);

    /// The output of a tool (xdotool, xprop, xwininfo). Throws std::runtime_error if it is missing
    /// or fails.
    std::string tool(const std::vector<std::string>& words) const;
    /// The same; false if it fails, for example because what it looks for does not exist.
    bool try_tool(const std::vector<std::string>& words, std::string& out) const;

    /// The whole screen.
    Place place() const;
    /// Black where `part` is beyond the screen.
    Seen see(const Place& part) const;

    const std::string& variable() const { return variable_; }  // "DISPLAY=:N"

 private:
    TemporaryFolder folder_;
    std::string variable_;
    Background display_;  // last: it ends before its folder
};

/// A `kilolux view` of the scene plain, and its window.
class Viewer {
 public:
    /// Returns when the window is visible, with or without a picture. `more`: arguments.
    explicit Viewer(const Desktop& desktop, const std::vector<std::string>& more = {});

    Background& program() { return program_; }
    const std::string& window() const { return window_; }  // for xdotool

    /// Presses and releases a key, as xdotool calls it, wherever the focus is.
    void key(const std::string& name) const;
    Place place() const;  // of the window on the screen, without decoration
    bool is_minimised() const;
    void minimise() const;
    /// Waits until the window has the focus.
    void activate() const;
    bool has_focus() const;
    /// Returns after it has waited four times in full without work.
    void wait_for_rest() const;
    /// The place of the picture, without the overlays.
    Place picture() const;
    /// The picture once no work is left, while the program waits for input.
    Seen final_picture() const;
    /// Waits until the picture differs, where it keeps changing.
    void wait_for_change() const;
    /// Waits until the final picture is this one.
    void wait_for_picture(const Seen& wanted) const;

    /// The calls of GLFW so far, see recorder/glfw_recorder.cpp.
    std::vector<std::string> record() const;
    std::size_t count(const std::string& call) const;

 private:
    const Desktop& desktop_;
    TemporaryFolder folder_;
    Background program_;
    std::string window_;
};

}  // namespace kilolux
