// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "host/measure/report/columns.h"
#include "host/measure/roofline/stages.h"
#include "host/stages/tails/cut_light_tree.h"

namespace kilolux {
namespace {

using Row = ReportRow;

// The sum of the medians of a group's stages; empty where none of them ran.
Column<Row> group_column(const std::string& name, StageGroup group) {
    return {name, [group](const Row& row) {
                std::optional<double> sum;
                for (const ReportStage& stage : row.speed.stages) {
                    if (group_of(stage.name) == group) sum = sum.value_or(0.0) + stage.ms.median;
                }
                return sum;
            }};
}

// A column of report_table() under another name.
Column<Row> renamed(const std::string& name, std::string_view column) {
    static const std::vector<ReportColumn> all = report_columns({});
    const auto found = std::ranges::find(all, column, &ReportColumn::name);
    assert(found != all.end());
    Column<Row> out = *found;
    out.name = name;
    return out;
}

bool casts_shadows(const Row& row) { return row.setting.settings.shadows != Shadows::off; }

bool has_estimate(const Row& row) { return row.estimate.has_value(); }

bool has_estimate_of(const Row& row, EstimateKind kind) {
    return row.estimate && row.estimate->kind == kind;
}

void add_estimates(std::vector<Column<Row>>& columns, const std::vector<Row>& rows) {
    for (const ReportColumn& column : estimate_columns()) {
        if (column.is_shown(rows)) columns.push_back(column);
    }
}

// Frame time against `error`, of the rows that have one above 0, and its Pareto front.
Plot error_plot(const std::vector<Row>& rows, const std::string& caption, const RowError& error) {
    Plot plot;
    plot.subtitle = caption;
    plot.x_label = "frame [ms] (ratio to the default's in pairs of frames; bars: 5 % to 95 %)";
    plot.log_x = plot.log_y = true;
    const double standard_ms = rows.empty() ? 0.0 : rows.front().speed.frame_ms;
    for (const Row& row : rows) {
        const std::optional<double> y = error(row);
        if (!y || !(*y > 0.0)) continue;  // the axis is logarithmic
        const ReportSpeed& s = row.speed;
        PlotPoint point{s.relative * standard_ms, *y};
        point.x_low = s.relative_p5 * standard_ms;
        point.x_high = s.relative_p95 * standard_ms;
        plot.series.push_back(
            {row.setting.name, {point}, PlotStyle::points, static_cast<int>(row.setting.axis)});
    }
    if (plot.series.empty()) return plot;
    PlotSeries front{"Pareto front", {}, PlotStyle::steps};
    for (const std::size_t i : front_of(rows, error))
        front.points.push_back({rows[i].speed.relative * standard_ms, *error(rows[i])});
    plot.series.push_back(std::move(front));
    return plot;
}

// The errors of sampled shadows over their rays; empty with fewer than three numbers of rays.
Plot rays_plot(const std::vector<Row>& rows, const std::string& caption) {
    std::map<int, const Row*> by_rays;
    for (const Row& row : rows) {
        const RenderSettings& s = row.setting.settings;
        if (row.estimate && row.estimate->within) by_rays.emplace(s.shadow_rays, &row);
    }
    Plot plot;
    if (by_rays.size() < 3) return plot;
    plot.title = "Sampled shadows: error over rays";
    plot.subtitle = caption;
    plot.x_label = "rays a pixel N, at most on average (--shadow-rays)";
    plot.y_label = "error [radiance]";
    plot.log_x = plot.log_y = true;
    const auto& [fewest, first] = *by_rays.begin();
    for (const auto& [rays, row] : by_rays) {
        const double n = rays, slope = std::sqrt(fewest / n);
        series_of(plot, "RMSE against R2").push_back({n, row->surfaces.hdr.rmse});
        series_of(plot, "luminance's error against R1").push_back({n, row->estimate->error});
        series_of(plot, "its estimate").push_back({n, row->estimate->estimated});
        series_of(plot, "1/sqrt(N)").push_back({n, first->estimate->estimated * slope});
    }
    return plot;
}

// A kind of plot: file, title, y axis, and a row's y where it is shown.
struct PlotKind {
    const char* stem;
    const char* title;
    const char* y_label;
    std::optional<double> (*error)(const Row& row);
};

constexpr PlotKind kPlots[] = {
    {"time_against_error", "Speed against error: the picture asked for, in float64 (R2)",
     "RMSE against R2 [radiance]", surfaces_rmse},
    {"time_against_unbounded_error", "Speed against error: lights without a range, in float64 (R3)",
     "RMSE against R3 [radiance]", unbounded_rmse},
    {"time_against_tails_error",
     "Speed against error: lights without a range, on the same surfaces",
     "RMSE against every light at every pixel [radiance]", tails_rmse},
    {"time_against_bound", "Speed against the estimated error, a bound",
     "median of the AOV error-bound [radiance]",
     [](const Row& row) {
         return has_estimate_of(row, EstimateKind::bound) ? std::optional(row.estimate->estimated)
                                                          : std::nullopt;
     }},
    {"time_against_standard_error", "Speed against the estimated error, a standard error",
     "root mean square of the luminance's standard error [radiance]",
     [](const Row& row) {
         return has_estimate_of(row, EstimateKind::standard)
                    ? std::optional(row.estimate->estimated)
                    : std::nullopt;
     }},
    {"time_against_cut_off", "Speed against the radiance at which lights are cut off",
     "cut-off [radiance on a white surface]", [](const Row& row) {
         const bool shown = compares_cut_offs(row.setting.axis) && row.cut_off > 0.0;
         return shown ? std::optional(row.cut_off) : std::nullopt;
     }}};

}  // namespace

Table report_table(const std::vector<Row>& rows) {
    std::vector<Column<Row>> columns;
    for (const ReportColumn& column : report_columns(stage_names(rows))) {
        if (column.is_shown == nullptr || column.is_shown(rows)) columns.push_back(column);
    }
    return make_table(columns, rows);
}

Table report_summary(const std::vector<Row>& rows) {
    std::vector<Column<Row>> columns = {renamed("setting", "setting"),
                                        renamed("Pareto", "pareto"),
                                        renamed("frame [ms]", "frame [ms]"),
                                        renamed("x default", "times default"),
                                        group_column("draw", StageGroup::surfaces),
                                        group_column("lists", StageGroup::lists)};
    if (std::ranges::any_of(rows, casts_shadows))
        columns.push_back(group_column("cast", StageGroup::shadows));
    columns.push_back(group_column("shade", StageGroup::shading));
    for (const auto& [name, column] : {std::pair{"k", "k"},
                                       {"k*/k", "k*/k"},
                                       {"G eval/s", "G evaluations/s"},
                                       {"R1 max rel", "R1 max rel"},
                                       {"R1 RMSE", "R1 rmse"},
                                       {"rasterised RMSE", "rasterised rmse"},
                                       {"R2 RMSE", "R2 rmse"},
                                       {"R2 PSNR [dB]", "R2 psnr [dB]"},
                                       {"R2 SSIM", "R2 ssim"},
                                       {"R2 FLIP", "R2 flip mean"},
                                       {"R3 RMSE", "R3 rmse"},
                                       {"R3 FLIP", "R3 flip mean"}}) {
        columns.push_back(renamed(name, column));
    }
    add_estimates(columns, rows);
    return make_table(columns, rows);
}

Table cut_off_table(const std::vector<Row>& rows) {
    std::vector<Row> shown;
    for (const Row& row : rows) {
        if (compares_cut_offs(row.setting.axis)) shown.push_back(row);
    }
    if (shown.size() < 2) shown.clear();
    std::vector<Column<Row>> columns = {
        renamed("setting", "setting"),
        {"Pareto", [](const Row& row) { return row.tails_front ? "yes" : ""; }},
        renamed("frame [ms]", "frame [ms]"),
        renamed("x default", "times default"),
        stage_column("cut [ms]", kCutLightTreeStage.name),
        group_column("shade [ms]", StageGroup::shading),
        renamed("k", "k"),
        renamed("tails RMSE", "tails rmse"),
        renamed("tails relMSE", "tails relmse"),
        renamed("R3 RMSE", "R3 rmse")};
    add_estimates(columns, shown);
    columns.push_back(renamed("time", "scaled"));
    return make_table(columns, shown);
}

std::string report_notes(const std::vector<Row>& rows) {
    const RenderSettings& s = rows.front().setting.settings;
    return fmt::format(
        "Errors are measured on pictures of {}x{} pixels (--error-width sets this), times on "
        "{}x{}.\n"
        "x default: frame time relative to the default's, median over pairs of frames.\n"
        "k: lights evaluated per surface pixel. k*: those of them in range. k*/k: the useful "
        "share.\n"
        "R1: against float64 shading of the stored surfaces, the kernels' error. rasterised: of "
        "the "
        "unquantised surfaces.\n"
        "R2: against float64 ray casting, the error of the whole picture. R3: as R2, with lights "
        "of unlimited range.\n{}",
        rows.front().picture.width, rows.front().picture.height, s.width, s.height,
        std::ranges::any_of(rows, has_estimate)
            ? "estimated error: a bound (the median over the pixels) or a standard error (the root "
              "mean square); estimated / error: its ratio to the same of the actual error. "
              "in 95 %: of the pixels with noise, those whose value in the mean is within their "
              "interval.\n"
            : "");
}

std::vector<NamedPlot> report_plots(const std::vector<Row>& rows, const std::string& caption) {
    std::vector<NamedPlot> out;
    for (const PlotKind& kind : kPlots) {
        Plot plot = error_plot(rows, caption, kind.error);
        if (plot.series.empty()) continue;
        plot.title = kind.title;
        plot.y_label = kind.y_label;
        out.push_back({kind.stem, std::move(plot)});
    }
    Plot over_rays = rays_plot(rows, caption);
    if (!over_rays.series.empty()) out.push_back({"error_over_rays", std::move(over_rays)});
    return out;
}

}  // namespace kilolux
