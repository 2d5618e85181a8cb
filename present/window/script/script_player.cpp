// SPDX-License-Identifier: Apache-2.0
#include "present/window/script/script_player.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <cmath>
#include <map>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "present/cli/option_values.h"

namespace kilolux {
namespace {

constexpr int kDragFrames = 6;
constexpr int kMaxTries = 60;  // frames until a widget must be visible

struct Keys {
    int key = 0;
    int modifiers = 0;
};

int key_code(const std::string& place, const std::string& name) {
    static const std::map<std::string, int> named = {
        {"Tab", GLFW_KEY_TAB},          {"Space", GLFW_KEY_SPACE}, {"Escape", GLFW_KEY_ESCAPE},
        {"Enter", GLFW_KEY_ENTER},      {"F1", GLFW_KEY_F1},       {"F11", GLFW_KEY_F11},
        {"Shift", GLFW_KEY_LEFT_SHIFT}, {"Alt", GLFW_KEY_LEFT_ALT}};
    const auto found = named.find(name);
    if (found != named.end()) return found->second;
    const char c = name.size() == 1 ? name[0] : '\0';
    // GLFW's codes of letters and digits are their ASCII ones.
    if ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')) return c;
    throw UsageError(place + ": '" + name + "' is not a key: A to Z, 0 to 9, Tab, Space, Escape, " +
                     "Enter, F1, F11, Shift, Alt");
}

// "Shift+V"
Keys keys_of(const std::string& place, const std::string& text) {
    Keys out;
    std::string rest = text;
    for (std::size_t plus = rest.find('+'); plus != std::string::npos; plus = rest.find('+')) {
        const std::string modifier = rest.substr(0, plus);
        const int bits[] = {GLFW_MOD_SHIFT, GLFW_MOD_CONTROL, GLFW_MOD_ALT};
        out.modifiers |= bits[parse_name(place + ": modifier", modifier, {"Shift", "Ctrl", "Alt"})];
        rest = rest.substr(plus + 1);
    }
    out.key = key_code(place, rest);
    return out;
}

// Words from `first` up to the last `left_out`, with spaces between.
std::string phrase(const ScriptStep& step, std::size_t left_out) {
    std::string out;
    for (std::size_t i = 1; i + left_out < step.words.size(); ++i) {
        out += (out.empty() ? "" : " ") + step.words[i];
    }
    return out;
}

double number(const ScriptStep& step, std::size_t word) {
    return parse_number(step.place, step.words.at(word));
}

}  // namespace

ScriptPlayer::ScriptPlayer(std::vector<ScriptStep> steps, ScriptStage stage)
    : steps_(steps.begin(), steps.end()), stage_(std::move(stage)) {}

void ScriptPlayer::advance() {
    if (actions_.empty() && !steps_.empty()) {
        const ScriptStep step = std::move(steps_.front());
        steps_.pop_front();
        place_ = step.place;
        tries_ = 0;
        begin(step);
    }
    if (!actions_.empty() && actions_.front()()) actions_.pop_front();
}

void ScriptPlayer::begin(const ScriptStep& step) {
    const std::string& name = step.words[0];
    if (name == "key") {
        add_key(step.words[1], number(step, 2));
    } else if (name == "resize") {
        stage_.screen.resize(
            {static_cast<int>(number(step, 1)), static_cast<int>(number(step, 2))});
        add_wait(2);
    } else if (name == "frames") {
        add_wait(static_cast<int>(number(step, 1)));
    } else if (name == "away") {
        move_to(-1.0, -1.0);
        add_wait(2);
    } else if (name == "settle") {
        add_settle();
    } else if (name == "screenshot") {
        stage_.screenshot(step.words[1]);
    } else if (name == "close") {
        stage_.screen.close();
    } else if (name == "drag" || name == "move" || name == "wheel") {
        begin_mouse(step);
    } else {
        begin_widget(step);
    }
}

void ScriptPlayer::begin_mouse(const ScriptStep& step) {
    const std::string& name = step.words[0];
    if (name == "wheel") {
        stage_.screen.post(WheelEvent{0.0, number(step, 1)});
        return add_wait(1);
    }
    const MoveEvent from{number(step, 1), number(step, 2)};
    actions_.push_back([this, from] { return move_to(from.x, from.y), true; });
    if (name == "move") return add_wait(2);
    const MoveEvent to{number(step, 3), number(step, 4)};
    const std::string button = step.words.size() > 5 ? step.words[5] : "left";
    const auto code = static_cast<int>(parse_name(step.place, button, {"left", "right", "middle"}));
    add_press(code, GLFW_PRESS);
    for (int i = 1; i <= kDragFrames; ++i) {
        const double t = static_cast<double>(i) / kDragFrames;
        const MoveEvent at{std::lerp(from.x, to.x, t), std::lerp(from.y, to.y, t)};
        actions_.push_back([this, at] { return move_to(at.x, at.y), true; });
    }
    add_press(code, GLFW_RELEASE);
}

void ScriptPlayer::begin_widget(const ScriptStep& step) {
    const std::string& name = step.words[0];
    if (name == "open") {
        const std::string section = "section " + phrase(step, 0);
        actions_.push_back([this, section] {
            if (!reach(section)) return false;
            if (!place_of(section).open) add_click(section);
            return true;
        });
    } else if (name == "click") {
        add_click(phrase(step, 0));
    } else if (name == "choose") {
        add_click(phrase(step, 1));
        add_click(phrase(step, 0));
    } else {
        // A drag reaches the value to within a pixel; typing then sets it exactly.
        if (name == "slide") add_slide(phrase(step, 1), number(step, step.words.size() - 1));
        add_value(phrase(step, 1), step.words.back());
    }
}

void ScriptPlayer::add_wait(int frames) {
    for (int i = 0; i < frames; ++i) {
        actions_.push_back([] { return true; });
    }
}

void ScriptPlayer::add_settle() {
    add_wait(2);  // the last step reaches the panel first
    actions_.push_back([this] {
        const PictureState state = stage_.picture_state();
        if (state == PictureState::endless) {
            throw Error(place_ + ": the picture never settles while the lights move");
        }
        waits_ = state == PictureState::pending;
        return !waits_;
    });
    add_wait(4);  // until the panel's layout of new results is final
}

void ScriptPlayer::add_key(const std::string& name, double seconds) {
    const Keys keys = keys_of(place_, name);
    const auto send = [this, keys](int action) {
        actions_.push_back([this, keys, action] {
            stage_.screen.post(KeyEvent{keys.key, 0, action, keys.modifiers});
            return true;
        });
    };
    send(GLFW_PRESS);
    add_wait(static_cast<int>(std::lround(seconds / kFrameSeconds)));
    send(GLFW_RELEASE);
    add_wait(1);
}

void ScriptPlayer::add_press(int button, int action, int modifiers) {
    actions_.push_back([this, button, action, modifiers] {
        stage_.screen.post(ButtonEvent{button, action, modifiers});
        return true;
    });
    add_wait(1);
}

// Brings the mouse to the middle of a widget, and presses Ctrl where `modifiers` has it.
void ScriptPlayer::add_reach(const std::string& widget, int modifiers) {
    // New results move widgets: until it stands where the mouse is.
    actions_.push_back([this, widget] {
        if (!reach(widget)) return false;
        const MoveEvent before = mouse_;
        move_to(place_of(widget).middle_x(), place_of(widget).middle_y());
        if (mouse_.x == before.x && mouse_.y == before.y) return true;
        if (++tries_ > kMaxTries) throw Error(place_ + ": '" + widget + "' does not stand still");
        return false;
    });
    if (modifiers == 0) return;
    actions_.push_back([this, modifiers] {
        stage_.screen.post(KeyEvent{GLFW_KEY_LEFT_CONTROL, 0, GLFW_PRESS, modifiers});
        return true;
    });
    add_wait(1);
}

void ScriptPlayer::add_click(const std::string& widget, int modifiers) {
    add_reach(widget, modifiers);
    add_press(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, modifiers);
    add_press(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, modifiers);
    if (modifiers == 0) return;
    actions_.push_back([this] {
        stage_.screen.post(KeyEvent{GLFW_KEY_LEFT_CONTROL, 0, GLFW_RELEASE, 0});
        return true;
    });
}

void ScriptPlayer::add_slide(const std::string& widget, double value) {
    add_reach(widget);
    add_press(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS);
    for (int i = 1; i <= kDragFrames; ++i) {
        const double t = static_cast<double>(i) / kDragFrames;
        actions_.push_back([this, widget, value, t] {
            const WidgetPlace& place = place_of(widget);
            move_to(std::lerp(place.middle_x(), place.x_of(value), t), place.middle_y());
            return true;
        });
    }
    add_wait(1);
    add_press(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE);
}

void ScriptPlayer::add_value(const std::string& widget, const std::string& text) {
    actions_.push_back([this, widget] { return reach(widget); });
    actions_.push_back([this, widget, text, value = parse_number(place_, text)] {
        const std::optional<SliderRange>& range = place_of(widget).slider;
        if (!range) throw Error(place_ + ": '" + widget + "' is not a slider");
        if (value >= range->low && value <= range->high) return true;
        throw Error(fmt::format("{}: {} is not on the slider '{}', {:.10g} to {:.10g}", place_,
                                text, widget, range->low, range->high));
    });
    add_click(widget, GLFW_MOD_CONTROL);
    add_wait(1);
    for (const char c : text) {
        actions_.push_back([this, c] {
            stage_.screen.post(TextEvent{static_cast<unsigned char>(c)});
            return true;
        });
    }
    add_key("Enter", 0.0);
}

const WidgetPlace& ScriptPlayer::place_of(const std::string& widget) const {
    const WidgetPlace* place = stage_.ui.find(widget);
    if (place != nullptr) return *place;
    throw Error(place_ + ": there is no '" + widget + "' on the panel" +
                did_you_mean(widget, stage_.ui.names()) + " (is its section open?)");
}

// Scrolls the panel until the widget is in sight.
bool ScriptPlayer::reach(const std::string& widget) {
    const WidgetPlace* place = stage_.ui.find(widget);
    if (place != nullptr && !place->refusal.empty()) {
        throw Error(fmt::format("{}: '{}' is disabled: {}", place_, widget, place->refusal));
    }
    if (place != nullptr && place->visible) return true;
    if (++tries_ > kMaxTries) {
        const WidgetPlace& found = place_of(widget);
        throw Error(fmt::format("{}: '{}' does not come into sight; it is at {:.0f}", place_,
                                widget, found.middle_y()));
    }
    if (place == nullptr) return false;
    const double height = stage_.screen.size()[1];
    move_to(20.0, 0.5 * height);
    stage_.screen.post(WheelEvent{0.0, place->middle_y() > 0.5 * height ? -1.0 : 1.0});
    return false;
}

void ScriptPlayer::move_to(double x, double y) {
    mouse_ = {x, y};
    stage_.screen.post(mouse_);
}

}  // namespace kilolux
