// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "present/window/app/input.h"
#include "present/window/app/window.h"
#include "present/window/panel/widgets.h"

namespace kilolux {

/// One line of a script.
struct ScriptStep {
    std::string place;               // "FILE:LINE", for messages
    std::vector<std::string> words;  // at least one
};

/// Reads a script: one step a line, empty lines and those that begin with '#' left out. Throws
/// UsageError for a step that there is not or one with the wrong words, Error if the file cannot be
/// read.
///
///     key W 0.5            hold a key for half a second; also key Shift+V 0
///     drag X0 Y0 X1 Y1 [left|right|middle]
///     move X Y             the mouse
///     wheel N              clicks, away from the person
///     open SECTION         of the panel; does nothing if it is open
///     click NAME           a button or box of the panel
///     choose NAME VALUE    from a list of the panel
///     slide NAME VALUE     a slider, as near to the value as its pixels are
///     type NAME VALUE      into a slider
///     resize W H
///     frames N             let the window draw N times
///     settle               until the picture is what the settings say, in full
///     screenshot FILE      of the window
///     close
std::vector<ScriptStep> read_script(const std::filesystem::path& file);

/// What a script acts on.
struct ScriptStage {
    const Window& window;
    const Widgets& ui;
    std::function<bool()> is_settled;
    std::function<void(const std::filesystem::path&)> screenshot;
};

/// Plays a script: does to a window what a person's hands would do, through the same events.
class ScriptPlayer {
 public:
    /// Seconds that pass for the window in a frame while a script plays.
    static constexpr double kFrameSeconds = 1.0 / 30.0;

    ScriptPlayer(std::vector<ScriptStep> steps, ScriptStage stage);

    /// What happens before the next frame. Throws Error that names the line when a widget is not
    /// there.
    void advance();

    bool is_done() const { return steps_.empty() && actions_.empty(); }
    /// Waiting for the renderer: frames need not follow each other fast.
    bool is_settling() const { return settling_; }

 private:
    // True when it is done; else it is called again in the next frame.
    using Action = std::function<bool()>;

    void begin(const ScriptStep& step);
    void begin_mouse(const ScriptStep& step);
    void begin_widget(const ScriptStep& step);
    void add_key(const std::string& name, double seconds);
    void add_press(int button, int action, int modifiers = 0);
    void add_click(const std::string& widget, int modifiers = 0);
    void add_slide(const std::string& widget, double value);
    void add_text(const std::string& text);
    void add_settle();
    void add_wait(int frames);
    bool reach(const std::string& widget);
    const WidgetPlace& place_of(const std::string& widget) const;
    void move_to(double x, double y);

    std::deque<ScriptStep> steps_;
    ScriptStage stage_;
    std::deque<Action> actions_;
    std::string place_;
    MoveEvent mouse_;
    int tries_ = 0;  // frames that the widget has been looked for
    bool settling_ = false;
};

}  // namespace kilolux
