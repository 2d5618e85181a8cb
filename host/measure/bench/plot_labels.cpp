// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kilolux {
namespace {

// Of gnuplot's 'Sans,9', with a margin [pixel].
constexpr double kCharacter = 7.0;
constexpr double kLine = 15.0;
constexpr double kNear = 16.0;  // beyond this a line joins a label to its point [pixel]

bool inside(const PlotBox& box, const PlotBox& frame) {
    return box.left >= frame.left && box.right <= frame.right && box.bottom >= frame.bottom &&
           box.top <= frame.top;
}

PlotBox box_of(const PlotLabel& label) {
    const double width = kCharacter * static_cast<double>(label.text.size());
    return {label.x, label.y - 0.5 * kLine, label.x + width, label.y + 0.5 * kLine};
}

// The label with its nearest edge or corner at `distance` from its point, in one of 12 directions.
PlotLabel moved(PlotLabel label, double distance, int direction) {
    const double angle = direction * std::numbers::pi / 6.0;
    const double width = kCharacter * static_cast<double>(label.text.size());
    label.x = label.point_x + distance * std::cos(angle) + 0.5 * width * (std::cos(angle) - 1.0);
    label.y = label.point_y + (distance + 0.5 * kLine) * std::sin(angle);
    label.far = distance > kNear;
    return label;
}

}  // namespace

std::vector<PlotLabel> placed_labels(const std::vector<PlotLabel>& labels,
                                     const std::vector<PlotBox>& obstacles, const PlotArea& area) {
    const PlotBox frame = {area.left * kPlotWidth, area.bottom * kPlotHeight,
                           area.right * kPlotWidth, area.top * kPlotHeight};
    std::vector<PlotBox> taken = obstacles;
    std::vector<PlotLabel> out;
    const auto place = [&](const PlotLabel& label) {
        for (const double distance : {9.0, 24.0, 40.0, 60.0, 85.0, 115.0, 150.0}) {
            for (int direction = 0; direction < 12; ++direction) {
                const PlotLabel candidate = moved(label, distance, direction);
                const PlotBox box = box_of(candidate);
                const auto blocked = [&](const PlotBox& other) { return box.overlaps(other); };
                if (!inside(box, frame) || std::any_of(taken.begin(), taken.end(), blocked))
                    continue;
                taken.push_back(box);
                out.push_back(candidate);
                return;
            }
        }
    };
    for (const PlotLabel& label : labels) place(label);
    return out;
}

}  // namespace kilolux
