// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/measure/metrics/pareto.h"

namespace kilolux {
namespace {

constexpr const char* kFrontName = "Pareto front";

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
    return std::ranges::any_of(series.points, [](const PlotPoint& p) { return p.low < p.high; });
}

bool has_x_bars(const PlotSeries& series) {
    return std::ranges::any_of(series.points,
                               [](const PlotPoint& p) { return p.x_low < p.x_high; });
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
    std::string columns = "1:2", style = lines ? "linespoints" : "points";
    if (has_x_bars(series)) {
        columns = "1:2:6:7:3:4";
        style = lines ? "xyerrorlines" : "xyerrorbars";
    } else if (has_error_bars(series)) {
        columns = "1:2:3:4";
        style = lines ? "yerrorlines" : "yerrorbars";
    }
    return fmt::format("DATA index {} using {} with {} lt {} pt 7 ps 0.8 lw 1.5 title {}", index,
                       columns, style, index + 1, title);
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

// Places on a picture with fixed margins.
struct PlotFrame {
    const Axis &x_axis, &y_axis;
    PlotArea area{};
    double x(double value) const {
        return kPlotWidth * std::lerp(area.left, area.right, x_axis.place(value));
    }
    double y(double value) const {
        return kPlotHeight * std::lerp(area.bottom, area.top, y_axis.place(value));
    }
    // Around the line between two corners.
    PlotBox box(double x0, double y0, double x1, double y1) const {
        constexpr double kRoom = 4.0;  // [pixel]
        return {x(std::min(x0, x1)) - kRoom, y(std::min(y0, y1)) - kRoom,
                x(std::max(x0, x1)) + kRoom, y(std::max(y0, y1)) + kRoom};
    }
};

// What labels must not cover: points with their bars, and the steps of the Pareto front.
std::vector<PlotBox> obstacles(const Plot& plot, const PlotFrame& frame) {
    std::vector<PlotBox> out;
    for (const PlotSeries& series : plot.series) {
        const bool front = plot.pareto_front && &series == &plot.series.back();
        for (std::size_t i = 0; i < series.points.size(); ++i) {
            const PlotPoint& p = series.points[i];
            out.push_back(frame.box(p.x_low, p.y, p.x_high, p.y));
            out.push_back(frame.box(p.x, p.low, p.x, p.high));
            if (!front || i + 1 == series.points.size()) continue;
            const PlotPoint& next = series.points[i + 1];
            out.push_back(frame.box(p.x, p.y, next.x, p.y));
            out.push_back(frame.box(next.x, p.y, next.x, next.y));
        }
    }
    return out;
}

// The labels, in fixed margins, and lines to the points of those that are apart from theirs.
std::string label_commands(const Plot& plot, const Axis& x, const Axis& y) {
    const PlotFrame frame{x, y};
    std::vector<PlotLabel> labels;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) {
            if (p.label.empty()) continue;
            labels.push_back({.text = p.label, .point_x = frame.x(p.x), .point_y = frame.y(p.y)});
        }
    }
    if (labels.empty()) return {};
    const PlotArea& area = frame.area;
    std::string out = fmt::format(
        "set lmargin at screen {}\nset rmargin at screen {}\n"
        "set bmargin at screen {}\nset tmargin at screen {}\n",
        area.left, area.right, area.bottom, area.top);
    for (const PlotLabel& l : placed_labels(labels, obstacles(plot, frame), area)) {
        out += fmt::format("set label {} at screen {},{} left font ',9' noenhanced\n",
                           quoted(l.text), l.x / kPlotWidth, l.y / kPlotHeight);
        if (!l.far) continue;
        const double width = 6.0 * static_cast<double>(l.text.size());
        out += fmt::format(
            "set arrow from screen {},{} to screen {},{} nohead lw 0.5 lc rgb '#909090'\n",
            l.point_x / kPlotWidth, l.point_y / kPlotHeight,
            std::clamp(l.point_x, l.x, l.x + width) / kPlotWidth, l.y / kPlotHeight);
    }
    return out;
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
            out += fmt::format("{} {} {} {} {}", p.x, p.y, p.low, p.high, data_text(p.label));
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
        "set key outside right top noenhanced\n"
        "set terminal pngcairo size {width},{height} font 'Sans,11' noenhanced\n"
        "set output {png}\n{plot}"
        "set terminal svg size {width},{height} font 'Sans,11' noenhanced background rgb 'white'\n"
        "set output {svg}\nreplot\nset output\n",
        fmt::arg("width", kPlotWidth), fmt::arg("height", kPlotHeight),
        fmt::arg("png", quoted(stem + ".png")), fmt::arg("plot", plot_command(plot)),
        fmt::arg("svg", quoted(stem + ".svg")));
    return frame + x.commands() + y.commands() + label_commands(plot, x, y) + outputs;
}

}  // namespace kilolux
