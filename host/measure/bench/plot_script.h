// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/bench/plot.h"

namespace kilolux {

constexpr int kPlotWidth = 1200;  // [pixel]
constexpr int kPlotHeight = 750;  // [pixel]

/// The points that can be drawn: finite, and above 0 on logarithmic axes. Series without a point
/// are left out.
Plot drawable(const Plot& plot);

/// gnuplot data of a drawable plot: a block a series, blocks two blank lines apart.
std::string plot_data(const Plot& plot);

/// gnuplot script of a drawable plot that reads STEM.dat and writes STEM.png and STEM.svg in the
/// folder it is run in. `stem` is a file name without a folder.
std::string plot_script(const Plot& plot, const std::string& stem);

}  // namespace kilolux
