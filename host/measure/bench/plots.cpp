// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plots.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/measure/roofline/stages.h"

namespace kilolux {
namespace {

// A horizontal axis: a field of the points as a number.
struct PlotAxis {
    const char* field;  // as fields_of() names it
    const char* stem;
    const char* title;
    const char* label;
    double (*x)(const SweepPoint&);
};

constexpr PlotAxis kPlotAxes[] = {
    {"lights", "time_against_lights", "Time against lights", "lights",
     [](const SweepPoint& p) { return static_cast<double>(p.lights); }},
    {"grid", "time_against_grid", "Time against the coarse grid",
     "tiles x * tiles y * slices per octave",
     [](const SweepPoint& p) { return 1.0 * p.grid[0] * p.grid[1] * p.grid[2]; }},
    {"lanes", "time_against_lanes", "Time against lanes", "lanes of a work-item",
     [](const SweepPoint& p) { return 1.0 * p.lanes; }},
    {"resolution", "time_against_resolution", "Time against resolution", "pixels",
     [](const SweepPoint& p) { return 1.0 * p.resolution[0] * p.resolution[1]; }},
};

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::count(names, name) > 0;
}

// The texts of the varying fields but one.
std::string curve_name(const SweepPoint& point, const std::vector<std::string>& varying,
                       const std::string& but) {
    std::string name;
    for (const auto& [field, text] : fields_of(point)) {
        if (!contains(varying, field) || field == but) continue;
        const bool bare = field == "renderer" || field == "resolution" || field == "gbuffer";
        if (!name.empty()) name += ", ";
        name += bare ? text : fmt::format("{} {}", field, text);
    }
    return name;
}

// Keeps curves of two points or more, sorted by x; whether there is one.
bool finish(Plot& plot) {
    std::erase_if(plot.series, [](const PlotSeries& s) { return s.points.size() < 2; });
    for (PlotSeries& series : plot.series) {
        std::ranges::stable_sort(series.points, {}, &PlotPoint::x);
    }
    return !plot.series.empty();
}

// The rows that lie on curves along a field, and the fields in which those curves differ.
struct Curves {
    std::vector<BenchRow> rows;
    std::vector<std::string> varying;
};

Curves curves_along(const std::string& field, const std::vector<BenchRow>& rows) {
    const std::vector<std::string> varying = varying_fields(rows);
    Curves curves;
    for (const BenchRow& row : rows) {
        const std::string name = curve_name(row.point, varying, field);
        const auto on_same_curve = [&](const BenchRow& other) {
            return other.point != row.point && curve_name(other.point, varying, field) == name;
        };
        if (std::ranges::any_of(rows, on_same_curve)) curves.rows.push_back(row);
    }
    curves.varying = varying_fields(curves.rows);
    return curves;
}

Plot time_plot(const PlotAxis& axis, const Curves& curves) {
    Plot plot;
    plot.title = axis.title;
    plot.x_label = axis.label;
    plot.y_label = "time [ms]";
    plot.log_x = plot.log_y = true;
    for (const BenchRow& row : curves.rows) {
        // Automatic values are not on the axis.
        const bool is_plotted =
            row.stage == kFrameStage.name || group_of(row.stage) == StageGroup::shading;
        if (!is_plotted || axis.x(row.point) <= 0.0) continue;
        const std::string name = curve_name(row.point, curves.varying, axis.field);
        series_of(plot, row.stage + (name.empty() ? "" : ", " + name))
            .push_back({axis.x(row.point), row.ms.median, row.ms.p5, row.ms.p95});
    }
    return plot;
}

// The same point by the renderer that evaluates every light.
const BenchRow* naive_row(const BenchRow& row, const std::vector<BenchRow>& rows) {
    for (const BenchRow& other : rows) {
        SweepPoint wanted = row.point;
        wanted.renderer = RendererKind::deferred_all;
        wanted.grid = other.point.grid;
        if (other.stage == kFrameStage.name && other.point == wanted) return &other;
    }
    return nullptr;
}

Plot speed_up_plot(const Curves& curves) {
    Plot plot;
    plot.title = "Speed-up over evaluating every light at every pixel";
    plot.x_label = "lights";
    plot.y_label = "frame time of deferred-all / frame time";
    plot.log_x = plot.log_y = true;
    for (const BenchRow& row : curves.rows) {
        if (row.stage != kFrameStage.name || row.point.renderer == RendererKind::deferred_all)
            continue;
        const BenchRow* naive = naive_row(row, curves.rows);
        if (!naive || row.ms.median <= 0.0) continue;
        series_of(plot, curve_name(row.point, curves.varying, "lights"))
            .push_back({static_cast<double>(row.point.lights), naive->ms.median / row.ms.median});
    }
    return plot;
}

}  // namespace

std::vector<NamedPlot> bench_plots(const std::vector<BenchRow>& rows, const std::string& subtitle) {
    std::vector<NamedPlot> plots;
    const auto add = [&](const std::string& stem, Plot plot, const Curves& curves) {
        if (!finish(plot)) return;
        plot.subtitle = subtitle + shared_fields(curves.rows);
        plots.push_back({stem, std::move(plot)});
    };
    for (const PlotAxis& axis : kPlotAxes) {
        const Curves curves = curves_along(axis.field, rows);
        add(axis.stem, time_plot(axis, curves), curves);
    }
    const Curves curves = curves_along("lights", rows);
    add("speed_up_against_lights", speed_up_plot(curves), curves);
    return plots;
}

}  // namespace kilolux
