// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kilolux {

/// Where a widget was in the last frame, in window coordinates, and how to reach its values: for
/// scripts, which find and click it as a person does.
struct WidgetPlace {
    float x0 = 0.0f, y0 = 0.0f, x1 = 0.0f, y1 = 0.0f;
    bool visible = false;  // its middle can be clicked
    bool is_slider = false;
    double low = 0.0, high = 1.0;  // of a slider
    bool logarithmic = false;
    bool open = false;  // of a section
    double middle_x() const { return 0.5 * (x0 + x1); }
    double middle_y() const { return 0.5 * (y0 + y1); }
    /// Where on a slider a value is.
    double x_of(double value) const;
};

/// A slider's ends.
struct SliderRange {
    double low = 0.0;
    double high = 1.0;
    bool logarithmic = false;  // low > 0
    const char* format = "%.2f";
};

/// The panel's widgets: a label at the left, the control at the right, and a note of where each is.
/// Names for scripts are the labels in lower case.
class Widgets {
 public:
    /// The frame's widgets begin; those of the last stay to be found until end_frame().
    void begin_frame();
    void end_frame();

    /// Columns of labels begin here with this width.
    void set_label_width(float width) { label_width_ = width; }

    bool section(const char* label, bool open_at_first);
    /// `owner`: what it belongs to where several have the same label; first word of its name.
    bool checkbox(const char* label, bool& value, const char* owner = "");
    bool button(const char* label, bool wide = false);
    /// `beside`: the label of a box that follows in the same line.
    bool slider(const char* label, double& value, const SliderRange& range,
                const char* beside = "");
    bool slider(const char* label, float& value, const SliderRange& range);
    bool slider(const char* label, int& value, const SliderRange& range);
    bool slider(const char* label, std::uint64_t& value, const SliderRange& range);
    bool choice(const char* label, int& value, const std::vector<std::string>& names);
    bool choice(const char* label, std::string& value, const std::vector<std::string>& names);
    /// Shown while the mouse is on the widget before.
    void tip(const char* text) const;

    const WidgetPlace* find(const std::string& name) const;
    std::vector<std::string> names() const;

 private:
    void label(const char* text, const char* beside = "") const;
    WidgetPlace& note(const std::string& name);

    float label_width_ = 100.0f;
    std::map<std::string, WidgetPlace> places_, coming_;
};

}  // namespace kilolux
