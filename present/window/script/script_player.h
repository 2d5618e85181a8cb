// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/script/script.h"

namespace kilolux {

/// Replays input, one step per line, through the events of user input.
class ScriptPlayer {
 public:
    /// A script's frames are this long, however long they take.
    static constexpr double kFrameSeconds = 1.0 / 30.0;

    ScriptPlayer(std::vector<ScriptStep> steps, ScriptStage stage);

    /// Does the steps before the next frame. Throws Error that names the line when a step fails.
    void advance();

    bool is_done() const { return steps_.empty() && actions_.empty(); }
    /// Whether it waits for the renderer.
    bool is_waiting() const { return waits_; }

 private:
    // Returns true when it is done; else it is called again in the next frame.
    using Action = std::function<bool()>;

    void begin(const ScriptStep& step);
    void begin_mouse(const ScriptStep& step);
    void begin_widget(const ScriptStep& step);
    void add_key(const std::string& name, double seconds);
    void add_press(int button, int action, int modifiers = 0);
    void add_reach(const std::string& widget, int modifiers = 0);
    void add_click(const std::string& widget, int modifiers = 0);
    void add_slide(const std::string& widget, double value);
    void add_value(const std::string& widget, const std::string& text);
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
    int tries_ = 0;  // frames in which the widget was looked for
    bool waits_ = false;
};

}  // namespace kilolux
