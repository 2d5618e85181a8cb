// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kilolux {
namespace {

bool drawable(double value, bool logarithmic) {
    return std::isfinite(value) && (!logarithmic || value > 0.0);
}

// `text` on one line between quotes, with each quote in it replaced.
std::string quoted(const std::string& text, char quote, std::string_view replacement) {
    std::string out(1, quote);
    for (const char c : text) {
        if (c == quote) {
            out += replacement;
        } else {
            out += c == '\n' || c == '\r' ? ' ' : c;
        }
    }
    return out + quote;
}

// A gnuplot string: only the quote itself is special.
std::string quoted(const std::string& text) { return quoted(text, '\'', "''"); }

// A string of a data file, which ends at the next quote.
std::string data_text(const std::string& text) { return quoted(text, '"', "'"); }

bool has_error_bars(const PlotSeries& series) {
    return std::ranges::any_of(series.points, [](const PlotPoint& p) { return p.low < p.high; });
}

bool has_x_bars(const PlotSeries& series) {
    return std::ranges::any_of(series.points,
                               [](const PlotPoint& p) { return p.x_low < p.x_high; });
}

// Of gnuplot's point types those that differ in shape: filled, then open, then strokes.
int point_type(std::size_t index) {
    constexpr int kTypes[] = {7, 5, 9, 11, 13, 6, 4, 8, 10, 12, 1, 2, 3};
    return kTypes[index % std::size(kTypes)];
}

// One element of the plot command. Series of one colour differ in their points.
std::string series_command(const Plot& plot, std::size_t index) {
    const PlotSeries& series = plot.series[index];
    const std::string title = quoted(series.name);
    if (series.style == PlotStyle::steps) {
        return fmt::format("DATA index {} using 1:2 with steps lc rgb '#b0b0b0' lw 4 title {}",
                           index, title);
    }
    const bool lines = series.style == PlotStyle::lines_and_points;
    std::string columns = "1:2", style = lines ? "linespoints" : "points";
    if (has_x_bars(series)) {
        columns = "1:2:5:6:3:4";
        style = lines ? "xyerrorlines" : "xyerrorbars";
    } else if (has_error_bars(series)) {
        columns = "1:2:3:4";
        style = lines ? "yerrorlines" : "yerrorbars";
    }
    const auto of_color = static_cast<std::size_t>(
        std::count_if(plot.series.begin(), plot.series.begin() + static_cast<std::ptrdiff_t>(index),
                      [&](const PlotSeries& s) { return s.color == series.color; }));
    const bool own = series.color < 0;
    return fmt::format("DATA index {} using {} with {} lt {} pt {} ps 0.8 lw 1.5 title {}", index,
                       columns, style, own ? static_cast<int>(index) + 1 : series.color + 1,
                       point_type(own ? 0 : of_color), title);
}

// Steps are drawn first, below the points.
std::string plot_command(const Plot& plot) {
    std::string out;
    for (const bool steps : {true, false}) {
        for (std::size_t i = 0; i < plot.series.size(); ++i) {
            if ((plot.series[i].style == PlotStyle::steps) != steps) continue;
            out += (out.empty() ? "plot " : ", \\\n     ") + series_command(plot, i);
        }
    }
    return out + "\n";
}

// Marks at 1, 2 and 5 times powers of ten over up to three decades, else at powers of ten.
std::string log_tics(char axis, double low, double high) {
    const bool narrow = std::log10(high / low) <= 3.0;
    std::string out;
    const int last = static_cast<int>(std::ceil(std::log10(high)));
    for (int decade = static_cast<int>(std::floor(std::log10(low))); decade <= last; ++decade) {
        for (const int factor : {1, 2, 5}) {
            const double value = factor * std::pow(10.0, decade);
            if ((factor > 1 && !narrow) || value < low || value > high) continue;
            out += fmt::format("{}'{:.6g}' {:.6g}", out.empty() ? "" : ", ", value, value);
        }
    }
    return fmt::format("set {}tics ({})\n", axis, out);
}

// An axis' range, with room for points at its ends.
struct Axis {
    char name;
    bool logarithmic;
    double low, high;

    Axis(char axis, bool log, const std::vector<double>& shown) : name(axis), logarithmic(log) {
        const auto [min, max] = std::minmax_element(shown.begin(), shown.end());
        low = *min;
        high = *max;
        if (log) {
            const double room = std::max(1.5, std::pow(high / low, 0.06));
            low /= room;
            high *= room;
        } else {
            const double room =
                high > low ? 0.06 * (high - low) : std::max(1.0, std::abs(high)) * 0.1;
            low -= room;
            high += room;
        }
    }

    std::string commands() const {
        std::string range = fmt::format("set {}range [{}:{}]\n", name, low, high);
        if (!logarithmic) return range;
        return fmt::format("set logscale {}\n{}{}", name, range, log_tics(name, low, high));
    }
};

Axis axis_of(char name, const Plot& plot) {
    const bool logarithmic = name == 'x' ? plot.log_x : plot.log_y;
    std::vector<double> shown;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) {
            const auto values =
                name == 'x' ? std::array{p.x, p.x_low, p.x_high} : std::array{p.y, p.low, p.high};
            for (const double value : values) {
                if (drawable(value, logarithmic)) shown.push_back(value);
            }
        }
    }
    return Axis(name, logarithmic, shown);
}

}  // namespace

Plot drawable(const Plot& plot) {
    Plot out = plot;
    out.series.clear();
    for (const PlotSeries& series : plot.series) {
        PlotSeries kept = series;
        std::erase_if(kept.points, [&](const PlotPoint& p) {
            return !drawable(p.x, plot.log_x) || !drawable(p.y, plot.log_y);
        });
        if (!kept.points.empty()) out.series.push_back(std::move(kept));
    }
    return out;
}

std::string plot_data(const Plot& plot) {
    std::string out;
    for (const PlotSeries& series : plot.series) {
        if (!out.empty()) out += "\n\n";
        out += "# " + data_text(series.name) + "\n";
        for (const PlotPoint& p : series.points) {
            out += fmt::format("{} {} {} {}", p.x, p.y, p.low, p.high);
            if (has_x_bars(series)) out += fmt::format(" {} {}", p.x_low, p.x_high);
            out += '\n';
        }
    }
    return out;
}

std::string plot_script(const Plot& plot, const std::string& stem) {
    const Axis x = axis_of('x', plot), y = axis_of('y', plot);
    const std::string frame = fmt::format(
        "# Run in this folder: gnuplot FILE\n"
        "DATA = {data}\n"
        "set title {title}.\"\\n\".{subtitle} noenhanced\n"
        "set xlabel {x} noenhanced\n"
        "set ylabel {y} noenhanced\n",
        fmt::arg("data", quoted(stem + ".dat")), fmt::arg("title", quoted(plot.title)),
        fmt::arg("subtitle", quoted(plot.subtitle)), fmt::arg("x", quoted(plot.x_label)),
        fmt::arg("y", quoted(plot.y_label)));
    const std::string outputs = fmt::format(
        "set grid xtics ytics lt 1 lw 0.5 lc rgb '#cccccc'\n"
        "set key outside right top noenhanced font 'Sans,9' samplen 1 spacing 0.9\n"
        "set terminal pngcairo size {width},{height} font 'Sans,11' noenhanced\n"
        "set output {png}\n{plot}"
        "set terminal svg size {width},{height} font 'Sans,11' noenhanced background rgb 'white'\n"
        "set output {svg}\nreplot\nset output\n",
        fmt::arg("width", kPlotWidth), fmt::arg("height", kPlotHeight),
        fmt::arg("png", quoted(stem + ".png")), fmt::arg("plot", plot_command(plot)),
        fmt::arg("svg", quoted(stem + ".svg")));
    return frame + x.commands() + y.commands() + outputs;
}

}  // namespace kilolux
