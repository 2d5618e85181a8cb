// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "present/window/overlay/cluster_view.h"
#include "present/window/panel/widgets.h"

namespace kilolux {

/// A line about a finished action, such as a saved file. It fades.
class Notice {
 public:
    void show(std::string text, double now);
    /// Fades. Returns whether its look changed since the last call. `now`: seconds of the same
    /// clock.
    bool fade(double now);
    const std::string& text() const { return text_; }  // empty: none
    float alpha() const { return alpha_; }

 private:
    std::string text_;
    double end_ = 0.0;  // [s]
    float alpha_ = 1.0f;
};

/// Lines and the notice in the upper right of the picture.
void describe_overlay(const std::vector<std::string>& lines, const Notice& notice,
                      const ScreenPlace& place, float scale);

/// The keys, in the middle of the picture, or of the window where the picture is too small. Its
/// text shrinks to fit.
void describe_help(const ScreenPlace& place, float scale);

/// Describes a message at the lower edge. Returns whether it was dismissed.
bool describe_failure(Widgets& ui, const std::string& text, const ScreenPlace& place, float scale);

}  // namespace kilolux
