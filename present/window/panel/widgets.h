// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace kilolux {

/// A slider's ends.
struct SliderRange {
    double low = 0.0;
    double high = 1.0;
    bool logarithmic = false;  // low > 0
    const char* format = "%.2f";
};

/// A field that is dragged: its ends, and what a pixel adds.
struct DragRange {
    double low = 0.0;
    double high = 1.0;
    double step = 0.01;
    const char* format = "%.4g";
};

/// The place of a widget in the last frame, in window coordinates: scripts find and click it as
/// users do.
struct WidgetPlace {
    float x0 = 0.0f, y0 = 0.0f, x1 = 0.0f, y1 = 0.0f;
    bool visible = false;               // it can be clicked
    bool open = false;                  // of a section
    std::optional<SliderRange> slider;  // of a slider or a field that is dragged
    std::string refusal{};              // why it is disabled; empty: it is not
    double middle_x() const { return 0.5 * (x0 + x1); }
    double middle_y() const { return 0.5 * (y0 + y1); }
    /// The place of a value on the slider.
    double x_of(double value) const;
};

/// The panel's widgets: a label at the left, the control at the right. The place of each is
/// recorded under its label in lower case, for scripts.
class Widgets {
 public:
    /// find() has the last frame's widgets until end_frame().
    void begin_frame();
    void end_frame();

    /// Columns of labels begin here with this width.
    void set_label_width(float width) { label_width_ = width; }

    /// Names of the widgets until end_group() begin with `group`; their labels do not.
    void begin_group(const char* group);
    void end_group();

    bool section(const char* label, bool open_at_first);
    /// `owner`: the first word of its name where several boxes have the same label.
    bool checkbox(const char* label, bool& value, const char* owner = "");
    bool button(const char* label, bool wide = false, bool enabled = true);
    /// `beside`: the label of a box that follows on the same line.
    template <typename T>
    bool slider(const char* label, T& value, const SliderRange& range, const char* beside = "") {
        double wide = static_cast<double>(value);
        if (!slide(label, wide, range, beside)) return false;
        value = static_cast<T>(std::is_integral_v<T> ? std::round(wide) : wide);
        return true;
    }
    /// Ctrl+click types a value.
    template <typename T>
    bool drag(const char* label, T& value, const DragRange& range, const char* beside = "") {
        double wide = static_cast<double>(value);
        if (!drag_number(label, wide, range, beside)) return false;
        value = static_cast<T>(wide);
        return true;
    }
    /// Linear red, green and blue from 0 to 1.
    bool color(const char* label, glm::vec3& value);
    /// `value`: the index of the chosen name, as a number or enumeration. `refusals`: why names are
    /// disabled, empty for those that are not; each stands below.
    template <typename T>
    bool choice(const char* label, T& value, const std::vector<std::string>& names,
                const std::vector<std::string>& refusals = {}) {
        auto place = static_cast<std::size_t>(value);
        if (!choose(label, place, names, refusals)) return false;
        value = static_cast<T>(place);
        return true;
    }
    /// Shown while the mouse is on the previous widget.
    void tip(const char* text) const;

    /// Widgets until end_refusal() are disabled for that reason, which stands below them; an empty
    /// one disables nothing.
    void begin_refusal(const std::string& reason);
    void end_refusal();

    const WidgetPlace* find(const std::string& name) const;
    std::vector<std::string> names() const;

 private:
    bool choose(const char* label, std::size_t& value, const std::vector<std::string>& names,
                const std::vector<std::string>& refusals);
    bool drag_number(const char* label, double& value, const DragRange& range, const char* beside);
    bool slide(const char* label, double& value, const SliderRange& range, const char* beside);
    void label(const char* text, const char* beside = "") const;
    void describe_refusal(const std::string& reason) const;
    WidgetPlace& note(const std::string& name);

    float label_width_ = 100.0f;
    std::string group_;    // with a space behind; empty: none
    std::string refusal_;  // of widgets now
    std::map<std::string, WidgetPlace> places_, coming_;
};

}  // namespace kilolux
