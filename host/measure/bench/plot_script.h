// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench/plot.h"

namespace kilolux {

/// The points that can be drawn: finite, and above 0 on logarithmic axes; with the Pareto front, if
/// asked for, as one more series. Series without a point are left out.
Plot drawable(const Plot& plot);

/// gnuplot data of a drawable plot: a block a series, blocks two blank lines apart.
std::string plot_data(const Plot& plot);

/// gnuplot script of a drawable plot that reads STEM.dat and writes STEM.png and STEM.svg in the
/// folder it is run in. `stem` is a file name without a folder.
std::string plot_script(const Plot& plot, const std::string& stem);

/// A point's label in a plot's area, whose sides are 0 and 1.
struct PlotLabel {
    std::string text;
    double x = 0.0;  // of the point
    double y = 0.0;
    bool left = false;   // the text stands to the left of the point
    bool below = false;  // and below it
};

/// Where the labels of points stand, so that none leaves the area or overlaps another one. Labels
/// without such a place are left out. `points` with x and y within the area.
std::vector<PlotLabel> place_labels(const std::vector<PlotPoint>& points);

}  // namespace kilolux
