// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kilolux {

struct PlotPoint {
    double x = 0.0;
    double y = 0.0;
    double low = y, high = y;      // ends of the error bar; equal: none
    double x_low = x, x_high = x;  // and of that along x
};

enum class PlotStyle {
    lines_and_points,
    points,
    steps,  // between two points only the left one's y is reachable: a thick line below the others
};

/// A curve or a cloud of points.
struct PlotSeries {
    std::string name;  // in the key
    std::vector<PlotPoint> points;
    PlotStyle style = PlotStyle::lines_and_points;
    int color = -1;  // a number of gnuplot's colours; -1: one of its own
};

struct Plot {
    std::string title;
    std::string subtitle{};  // what was measured, on which device
    std::string x_label;     // with its unit
    std::string y_label;
    bool log_x = false;
    bool log_y = false;
    std::vector<PlotSeries> series{};
};

/// A plot and its files' name without an extension.
struct NamedPlot {
    std::string stem;
    Plot plot;
};

/// The points of the plot's series of that name, which is added if it is new.
std::vector<PlotPoint>& series_of(Plot& plot, const std::string& name,
                                  PlotStyle style = PlotStyle::lines_and_points);

/// Whether gnuplot is there; else says that plots are left out, and the package that has it.
bool can_plot();

/// Writes STEM.dat and STEM.gnuplot, which draws the pictures again from the data, and runs
/// gnuplot, without a shell, which makes STEM.png and STEM.svg. The key names every series.
///
/// `stem`: path without an extension, in a folder that exists. Points that are not finite, or not
/// above 0 on a logarithmic axis, are left out. The four files appear together or not at all.
/// Throws Error when no point is left, when a file cannot be written, or when gnuplot fails, with
/// its message.
void write_plot(const Plot& plot, const std::filesystem::path& stem);

/// Each in `folder`.
void write_plots(const std::vector<NamedPlot>& plots, const std::filesystem::path& folder);

}  // namespace kilolux
