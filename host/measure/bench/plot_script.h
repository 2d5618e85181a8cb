// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench/plot.h"

namespace kilolux {

constexpr int kPlotWidth = 1200;  // [pixel]
constexpr int kPlotHeight = 750;  // [pixel]

/// The area between the axes, as shares of the picture from its lower left corner.
struct PlotArea {
    double left = 0.08, right = 0.82, bottom = 0.1, top = 0.9;
};

/// A rectangle of the picture, [pixel] from the lower left corner.
struct PlotBox {
    double left, bottom, right, top;
    bool overlaps(const PlotBox& o) const {
        return left < o.right && o.left < right && bottom < o.top && o.bottom < top;
    }
};

/// A point with its label on the picture, [pixel] from the lower left corner.
struct PlotLabel {
    std::string text;
    double point_x = 0.0, point_y = 0.0;
    double x = 0.0, y = 0.0;  // of the text's left end, at half its height
    bool far = false;         // away from its point: needs a line to it
};

/// Places the labels so that none covers another, an obstacle or the frame: beside its point, else
/// on circles around it. `labels`: text and point. `obstacles`: points, bars and lines. Labels that
/// do not fit are left out.
std::vector<PlotLabel> placed_labels(const std::vector<PlotLabel>& labels,
                                     const std::vector<PlotBox>& obstacles, const PlotArea& area);

/// The points that can be drawn: finite, and above 0 on logarithmic axes; with the Pareto front, if
/// asked for, as one more series. Series without a point are left out.
Plot drawable(const Plot& plot);

/// gnuplot data of a drawable plot: a block a series, blocks two blank lines apart.
std::string plot_data(const Plot& plot);

/// gnuplot script of a drawable plot that reads STEM.dat and writes STEM.png and STEM.svg in the
/// folder it is run in. `stem` is a file name without a folder.
std::string plot_script(const Plot& plot, const std::string& stem);

}  // namespace kilolux
