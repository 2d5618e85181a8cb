// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/measure/metrics/pareto.h"

namespace kilolux {
namespace {

constexpr const char* kFrontName = "Pareto front";

bool drawable(double value, bool logarithmic) {
    return std::isfinite(value) && (!logarithmic || value > 0.0);
}

// A single-quoted gnuplot string, in which only the quote itself is special, on one line.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') out += '\'';
        out += c == '\n' || c == '\r' ? ' ' : c;
    }
    return out + "'";
}

// A double-quoted string of a data file, which ends at the next double quote.
std::string data_text(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? '\'' : (c == '\n' || c == '\r' ? ' ' : c);
    return out + "\"";
}

PlotSeries front_of(const Plot& plot) {
    std::vector<CostAndError> points;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) points.push_back({p.x, p.y});
    }
    PlotSeries out{.name = kFrontName, .points = {}};
    for (const std::size_t i : pareto_set(points)) {
        out.points.push_back({points[i].cost, points[i].error});
    }
    return out;
}

bool has_error_bars(const PlotSeries& series) {
    return std::any_of(series.points.begin(), series.points.end(),
                       [](const PlotPoint& p) { return p.low < p.high; });
}

// One element of the plot command. The front is a thick line of steps: between two settings only
// the cheaper one's error can be had.
std::string series_command(const PlotSeries& series, std::size_t index, bool front) {
    const std::string title = quoted(series.name);
    if (front) {
        return fmt::format("DATA index {} using 1:2 with steps lc rgb '#b0b0b0' lw 4 title {}",
                           index, title);
    }
    const bool lines = series.style != PlotStyle::points;
    const bool bars = has_error_bars(series);
    return fmt::format(
        "DATA index {} using {} with {} lt {} pt 7 ps 0.8 lw 1.5 title {}", index,
        bars ? "1:2:3:4" : "1:2",
        bars ? (lines ? "yerrorlines" : "yerrorbars") : (lines ? "linespoints" : "points"),
        index + 1, title);
}

std::string plot_command(const Plot& plot) {
    std::string out = "plot ";
    // The front is the last series; it is drawn first, below the points.
    const std::size_t count = plot.series.size();
    const std::size_t shift = plot.pareto_front ? count - 1 : 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t index = (i + shift) % count;
        if (i > 0) out += ", \\\n     ";
        out += series_command(plot.series[index], index, plot.pareto_front && i == 0);
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

    // From 0 to 1 within the range.
    double place(double value) const {
        return logarithmic ? std::log(value / low) / std::log(high / low)
                           : (value - low) / (high - low);
    }

    std::string commands() const {
        const std::string range = fmt::format("set {}range [{}:{}]\n", name, low, high);
        if (!logarithmic) return range;
        return fmt::format("set logscale {}\n{}{}", name, range, log_tics(name, low, high));
    }
};

Axis axis_of(char name, const Plot& plot) {
    std::vector<double> shown;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) {
            if (name == 'x') {
                shown.push_back(p.x);
            } else {
                for (const double y : {p.y, p.low, p.high}) {
                    if (drawable(y, plot.log_y)) shown.push_back(y);
                }
            }
        }
    }
    return Axis(name, name == 'x' ? plot.log_x : plot.log_y, shown);
}

std::string label_commands(const Plot& plot, const Axis& x, const Axis& y) {
    std::vector<PlotPoint> points;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points)
            points.push_back({x.place(p.x), y.place(p.y), p.label});
    }
    std::string out;
    for (const PlotLabel& label : place_labels(points)) {
        out += fmt::format("set label {} at graph {},{} {} offset {},{} font ',9' noenhanced\n",
                           quoted(label.text), label.x, label.y, label.left ? "right" : "left",
                           label.left ? -0.7 : 0.7, label.below ? -0.5 : 0.5);
    }
    return out;
}

// A rectangle in a plot's area.
struct Box {
    double left, bottom, right, top;

    bool overlaps(const Box& other) const {
        return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
    }
    bool is_inside() const { return left >= 0.0 && bottom >= 0.0 && right <= 1.0 && top <= 1.0; }
};

// Of 9 point text in pictures of 1200 x 750 pixels, of which the area has about 900 x 620.
Box box_of(const PlotLabel& label) {
    constexpr double kCharacter = 0.0075, kHeight = 0.024, kGap = 0.008;
    const double width = kCharacter * static_cast<double>(label.text.size());
    const double left = label.left ? label.x - kGap - width : label.x + kGap;
    const double bottom = label.below ? label.y - kHeight : label.y;
    return {left, bottom, left + width, bottom + kHeight};
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
    if (out.series.empty()) return out;
    if (plot.pareto_front) out.series.push_back(front_of(out));
    return out;
}

std::string plot_data(const Plot& plot) {
    std::string out;
    for (const PlotSeries& series : plot.series) {
        if (!out.empty()) out += "\n\n";
        out += "# " + data_text(series.name) + "\n";
        for (const PlotPoint& p : series.points) {
            out += fmt::format("{} {} {} {} {}\n", p.x, p.y, p.low, p.high, data_text(p.label));
        }
    }
    return out;
}

std::vector<PlotLabel> place_labels(const std::vector<PlotPoint>& points) {
    std::vector<PlotLabel> labels;
    std::vector<Box> taken;
    for (const PlotPoint& p : points) {
        for (const int side : {0, 1, 2, 3}) {
            const PlotLabel label{p.label, p.x, p.y, side % 2 == 1, side >= 2};
            const Box box = box_of(label);
            const bool is_free = std::none_of(taken.begin(), taken.end(),
                                              [&](const Box& b) { return b.overlaps(box); });
            if (p.label.empty() || !box.is_inside() || !is_free) continue;
            labels.push_back(label);
            taken.push_back(box);
            break;
        }
    }
    return labels;
}

std::string plot_script(const Plot& plot, const std::string& stem) {
    const Axis x = axis_of('x', plot), y = axis_of('y', plot);
    std::string out = "# Run in this folder: gnuplot FILE\nDATA = " + quoted(stem + ".dat") + "\n";
    out += fmt::format("set title {}.\"\\n\".{} noenhanced\n", quoted(plot.title),
                       quoted(plot.subtitle));
    out += "set xlabel " + quoted(plot.x_label) + " noenhanced\n";
    out += "set ylabel " + quoted(plot.y_label) + " noenhanced\n";
    out += x.commands() + y.commands() + label_commands(plot, x, y);
    out += "set grid xtics ytics lt 1 lw 0.5 lc rgb '#cccccc'\n";
    out += "set key outside right top noenhanced\n";
    out += "set terminal pngcairo size 1200,750 font 'Sans,11' noenhanced\n";
    out += "set output " + quoted(stem + ".png") + "\n" + plot_command(plot);
    out += "set terminal svg size 1200,750 font 'Sans,11' noenhanced background rgb 'white'\n";
    out += "set output " + quoted(stem + ".svg") + "\nreplot\nset output\n";
    return out;
}

}  // namespace kilolux
