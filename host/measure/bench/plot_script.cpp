// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot_script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

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

bool has_labels(const PlotSeries& series) {
    for (const PlotPoint& p : series.points) {
        if (!p.label.empty()) return true;
    }
    return false;
}

// One element of the plot command; the front is a thick line of steps behind the points: between
// two settings only the cheaper one's error is to be had.
std::string series_command(const PlotSeries& series, std::size_t index, bool front) {
    const std::string block = "DATA index " + std::to_string(index);
    const std::string title = " title " + quoted(series.name);
    if (front) return block + " using 1:2 with steps lc rgb '#b0b0b0' lw 4" + title;
    const std::string color = " lt " + std::to_string(index + 1);
    const char* style = series.style == PlotStyle::points ? "points" : "linespoints";
    std::string out = block + " using 1:2 with " + style + color + " pt 7 ps 0.8 lw 1.5" + title;
    if (has_labels(series)) {
        out += ", \\\n     " + block +
               " using 1:2:3 with labels left offset 0.7,0.5 font ',9' notitle";
    }
    return out;
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

std::vector<double> values(const Plot& plot, double PlotPoint::*coordinate) {
    std::vector<double> out;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) out.push_back(p.*coordinate);
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

// Range and marks of an axis, with room for points and labels at its ends.
std::string axis_commands(const std::string& axis, bool logarithmic,
                          const std::vector<double>& shown) {
    const auto [min, max] = std::minmax_element(shown.begin(), shown.end());
    double low = *min, high = *max;
    if (logarithmic) {
        const double room = std::max(1.5, std::pow(high / low, 0.06));
        low /= room;
        high *= room;
    } else {
        const double room = high > low ? 0.06 * (high - low) : std::max(1.0, std::abs(high)) * 0.1;
        low -= room;
        high += room;
    }
    std::string out = "set " + axis + "range [" + number(low) + ':' + number(high) + "]\n";
    if (!logarithmic) return out;
    return "set logscale " + axis + "\n" + out + log_tics(axis, low, high);
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
            out += number(p.x) + ' ' + number(p.y) + ' ' + data_text(p.label) + '\n';
        }
    }
    return out;
}

std::string plot_script(const Plot& plot, const std::string& stem) {
    std::string out = "# Run in this folder: gnuplot FILE\nDATA = " + quoted(stem + ".dat") + "\n";
    out += "set title " + quoted(plot.title) + " noenhanced\n";
    out += "set xlabel " + quoted(plot.x_label) + " noenhanced\n";
    out += "set ylabel " + quoted(plot.y_label) + " noenhanced\n";
    out += axis_commands("x", plot.log_x, values(plot, &PlotPoint::x));
    out += axis_commands("y", plot.log_y, values(plot, &PlotPoint::y));
    out += "set grid xtics ytics lt 1 lw 0.5 lc rgb '#cccccc'\n";
    out += "set key outside right top noenhanced\n";
    out += "set terminal pngcairo size 1200,750 font 'Sans,11' noenhanced\n";
    out += "set output " + quoted(stem + ".png") + "\n" + plot_command(plot);
    out += "set terminal svg size 1200,750 font 'Sans,11' noenhanced background rgb 'white'\n";
    out += "set output " + quoted(stem + ".svg") + "\nreplot\nset output\n";
    return out;
}

}  // namespace kilolux
