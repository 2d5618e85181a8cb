// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot_script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "host/measure/bench/plot_labels.h"
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

std::string number(double value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
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

template <class Condition>
bool any_point(const PlotSeries& series, const Condition& condition) {
    return std::any_of(series.points.begin(), series.points.end(), condition);
}

bool has_bars(const PlotSeries& series) {
    return any_point(series, [](const PlotPoint& p) { return p.x_bar || p.y_bar; });
}

bool has_labels(const Plot& plot) {
    return std::any_of(plot.series.begin(), plot.series.end(), [](const PlotSeries& series) {
        return any_point(series, [](const PlotPoint& p) { return !p.label.empty(); });
    });
}

// One element of the plot command; the front is a thick line of steps behind the points: between
// two settings only the cheaper one's error is to be had.
std::string series_command(const PlotSeries& series, std::size_t index, bool front) {
    const std::string block = "DATA index " + std::to_string(index);
    const std::string title = " title " + quoted(series.name);
    if (front) return block + " using 1:2 with steps lc rgb '#b0b0b0' lw 4" + title;
    const std::string color = " lt " + std::to_string(index + 1);
    const char* style = series.style == PlotStyle::points ? "points" : "linespoints";
    std::string out;
    if (has_bars(series)) {
        out =
            block + " using 1:2:4:5:6:7 with xyerrorbars" + color + " pt 0 lw 1 notitle, \\\n     ";
    }
    return out + block + " using 1:2 with " + style + color + " pt 7 ps 0.8 lw 1.5" + title;
}

std::string plot_command(const Plot& plot) {
    std::string out = "plot ";
    // The front is the last series, drawn first, so that the points stay on top.
    const std::size_t count = plot.series.size();
    const std::size_t shift = plot.pareto_front ? count - 1 : 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t index = (i + shift) % count;
        if (i > 0) out += ", \\\n     ";
        out += series_command(plot.series[index], index, plot.pareto_front && i == 0);
    }
    return out + "\n";
}

// All values of a coordinate, with the ends of the bars.
std::vector<double> values(const Plot& plot, double PlotPoint::*coordinate,
                           std::optional<PlotBar> PlotPoint::*bar) {
    std::vector<double> out;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) {
            out.push_back(p.*coordinate);
            if (p.*bar) out.insert(out.end(), {(p.*bar)->low, (p.*bar)->high});
        }
    }
    return out;
}

// Marks at 1, 2 and 5 times powers of ten over a few decades, else at powers of ten.
std::string log_tics(const std::string& axis, double low, double high) {
    const bool narrow = std::log10(high / low) <= 3.0;
    std::string out;
    const int last = static_cast<int>(std::ceil(std::log10(high)));
    for (int decade = static_cast<int>(std::floor(std::log10(low))); decade <= last; ++decade) {
        for (const char* factor : {"1", "2", "5"}) {
            if (!narrow && *factor != '1') continue;
            std::string tic = factor;
            tic += 'e';
            tic += std::to_string(decade);
            const double value = std::strtod(tic.c_str(), nullptr);
            if (value < low || value > high) continue;
            if (!out.empty()) out += ", ";
            out += quoted(number(value));
            out += ' ';
            out += tic;
        }
    }
    return "set " + axis + "tics (" + out + ")\n";
}

struct Axis {
    bool logarithmic = false;
    double low = 0.0;
    double high = 1.0;
    // 0..1 along the axis.
    double share(double value) const {
        if (logarithmic) return std::log(value / low) / std::log(high / low);
        return (value - low) / (high - low);
    }
};

// The range of an axis, with room for points and labels at its ends.
Axis axis_of(bool logarithmic, const std::vector<double>& shown) {
    const auto [min, max] = std::minmax_element(shown.begin(), shown.end());
    if (logarithmic) {
        const double room = std::max(1.5, std::pow(*max / *min, 0.06));
        return {true, *min / room, *max * room};
    }
    const double room = *max > *min ? 0.06 * (*max - *min) : std::max(1.0, std::abs(*max)) * 0.1;
    return {false, *min - room, *max + room};
}

std::string axis_commands(const std::string& name, const Axis& axis) {
    std::string out =
        "set " + name + "range [" + number(axis.low) + ':' + number(axis.high) + "]\n";
    if (!axis.logarithmic) return out;
    return "set logscale " + name + "\n" + out + log_tics(name, axis.low, axis.high);
}

// Places on the picture.
struct PlotFrame {
    Axis x, y;
    PlotArea area;
    double left(double value) const {
        return kPlotWidth * std::lerp(area.left, area.right, x.share(value));
    }
    double bottom(double value) const {
        return kPlotHeight * std::lerp(area.bottom, area.top, y.share(value));
    }
    // Around the line between two corners.
    PlotBox box(double x0, double y0, double x1, double y1) const {
        constexpr double kRoom = 4.0;  // [pixel]
        return {left(std::min(x0, x1)) - kRoom, bottom(std::min(y0, y1)) - kRoom,
                left(std::max(x0, x1)) + kRoom, bottom(std::max(y0, y1)) + kRoom};
    }
};

// What labels must not cover: points with their bars, and the steps of the Pareto front.
std::vector<PlotBox> obstacles(const Plot& plot, const PlotFrame& frame) {
    std::vector<PlotBox> out;
    for (const PlotSeries& series : plot.series) {
        const bool front = plot.pareto_front && &series == &plot.series.back();
        for (std::size_t i = 0; i < series.points.size(); ++i) {
            const PlotPoint& p = series.points[i];
            const PlotBar x = p.x_bar.value_or(PlotBar{p.x, p.x});
            const PlotBar y = p.y_bar.value_or(PlotBar{p.y, p.y});
            out.push_back(frame.box(x.low, p.y, x.high, p.y));
            out.push_back(frame.box(p.x, y.low, p.x, y.high));
            if (!front || i + 1 == series.points.size()) continue;
            const PlotPoint& next = series.points[i + 1];
            out.push_back(frame.box(p.x, p.y, next.x, p.y));
            out.push_back(frame.box(next.x, p.y, next.x, next.y));
        }
    }
    return out;
}

// The labels and the lines to their points, in fixed margins.
std::string label_commands(const Plot& plot, const Axis& x, const Axis& y) {
    const PlotFrame frame{x, y, {}};
    const PlotArea& area = frame.area;
    std::vector<PlotLabel> labels;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) {
            if (p.label.empty()) continue;
            labels.push_back(
                {.text = p.label, .point_x = frame.left(p.x), .point_y = frame.bottom(p.y)});
        }
    }
    const auto at = [](double px, double py) {
        return "screen " + number(px / kPlotWidth) + ',' + number(py / kPlotHeight);
    };
    std::string out = "set lmargin at screen " + number(area.left) + "\nset rmargin at screen " +
                      number(area.right) + "\nset bmargin at screen " + number(area.bottom) +
                      "\nset tmargin at screen " + number(area.top) + '\n';
    for (const PlotLabel& l : placed_labels(labels, obstacles(plot, frame), area)) {
        out += "set label " + quoted(l.text) + " at " + at(l.x, l.y) + " left font ',9'\n";
        if (!l.far) continue;
        const double width = 6.0 * static_cast<double>(l.text.size());
        out += "set arrow from " + at(l.point_x, l.point_y) + " to " +
               at(std::clamp(l.point_x, l.x, l.x + width), l.y) +
               " nohead lw 0.5 lc rgb '#909090'\n";
    }
    return out;
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
            out += number(p.x) + ' ' + number(p.y) + ' ' + data_text(p.label);
            if (has_bars(series)) {
                const PlotBar x = p.x_bar.value_or(PlotBar{p.x, p.x});
                const PlotBar y = p.y_bar.value_or(PlotBar{p.y, p.y});
                for (const double end : {x.low, x.high, y.low, y.high}) out += ' ' + number(end);
            }
            out += '\n';
        }
    }
    return out;
}

std::string plot_script(const Plot& plot, const std::string& stem) {
    std::string out = "# Run in this folder: gnuplot FILE\nDATA = " + quoted(stem + ".dat") + "\n";
    out += "set title " + quoted(plot.title) + " noenhanced\n";
    out += "set xlabel " + quoted(plot.x_label) + " noenhanced\n";
    out += "set ylabel " + quoted(plot.y_label) + " noenhanced\n";
    const Axis x = axis_of(plot.log_x, values(plot, &PlotPoint::x, &PlotPoint::x_bar));
    const Axis y = axis_of(plot.log_y, values(plot, &PlotPoint::y, &PlotPoint::y_bar));
    out += axis_commands("x", x) + axis_commands("y", y);
    if (has_labels(plot)) out += label_commands(plot, x, y);
    if (!plot.caption.empty()) {
        out += "set label " + quoted(plot.caption) + " at screen 0.01,0.025 left font ',10'\n";
        if (!has_labels(plot)) out += "set bmargin 5\n";
    }
    out += "set grid xtics ytics lt 1 lw 0.5 lc rgb '#cccccc'\n";
    out += "set key outside right top noenhanced\n";
    out += "set terminal pngcairo size 1200,750 font 'Sans,11' noenhanced\n";
    out += "set output " + quoted(stem + ".png") + "\n" + plot_command(plot);
    out += "set terminal svg size 1200,750 font 'Sans,11' noenhanced background rgb 'white'\n";
    out += "set output " + quoted(stem + ".svg") + "\nreplot\nset output\n";
    return out;
}

}  // namespace kilolux
