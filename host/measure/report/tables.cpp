// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/tables.h"

#include <fmt/core.h>

#include <algorithm>

#include "host/measure/roofline/stages.h"
#include "host/stages/tails/cut_light_tree.h"

namespace kilolux {
namespace {

using Row = ReportRow;
using Errors = PictureErrors;

std::string size_text(int width, int height) { return fmt::format("{}x{}", width, height); }

std::string error_size_text(const Row& row) {
    return size_text(row.picture.width, row.picture.height);
}

std::vector<std::string> stage_names(const std::vector<Row>& rows) {
    std::vector<std::string> names;
    for (const Row& row : rows) {
        for (const ReportStage& stage : row.speed.stages) {
            if (std::ranges::count(names, stage.name) == 0) names.push_back(stage.name);
        }
    }
    return names;
}

// A column of the sum of the medians of stages by their names; empty where none of them ran.
template <typename IsSummed>
Column<Row> sum_column(const std::string& name, IsSummed is_summed) {
    return {name, [is_summed](const Row& row) {
                std::optional<double> sum;
                for (const ReportStage& stage : row.speed.stages) {
                    if (is_summed(stage.name)) sum = sum.value_or(0.0) + stage.ms.median;
                }
                return sum;
            }};
}

Column<Row> stage_column(const std::string& name, std::string_view stage) {
    return sum_column(name,
                      [stage = std::string(stage)](const std::string& s) { return s == stage; });
}

Column<Row> group_column(const std::string& name, StageGroup group) {
    return sum_column(name, [group](const std::string& s) { return group_of(s) == group; });
}

// A column of a count that is negative where nothing was counted.
Column<Row> count_column(const char* name, double ReportSpeed::*count) {
    return {name, [count](const Row& row) {
                const double value = row.speed.*count;
                return value < 0.0 ? Cell() : Cell(value);
            }};
}

Cell useful_share(const Row& row) {
    const ReportSpeed& s = row.speed;
    return s.k > 0.0 && s.useful_k >= 0.0 ? Cell(s.useful_k / s.k) : Cell();
}

std::string front_text(const Row& row) {
    if (row.surfaces_front && row.unbounded_front) return "R2 R3";
    return row.surfaces_front ? "R2" : (row.unbounded_front ? "R3" : "");
}

// The errors against one reference.
void add_errors(std::vector<Column<Row>>& columns, const std::string& of, Errors Row::*errors) {
    for (const ErrorMetric& metric : error_metrics()) {
        columns.push_back({fmt::format("{} {}", of, metric.column),
                           [=](const Row& row) { return metric.value(row.*errors); }});
    }
    columns.push_back({of + " worst pixel",
                       [=](const Row& row) { return pixel_text((row.*errors).hdr.absolute); }});
    columns.push_back({of + " worst rel pixel",
                       [=](const Row& row) { return pixel_text((row.*errors).hdr.relative); }});
}

bool casts_shadows(const Row& row) { return row.setting.settings.shadows != Shadows::off; }

// Whether devices of several names have measured the errors.
bool has_unlike_devices(const std::vector<Row>& rows) {
    const auto is_unlike = [&](const Row& row) {
        return row.gpu && row.gpu->info.name != rows.front().gpu->info.name;
    };
    return std::ranges::any_of(rows, is_unlike);
}

bool has_estimate(const Row& row) { return row.estimate.has_value(); }

bool has_estimate_of(const Row& row, EstimateKind kind) {
    return row.estimate && row.estimate->kind == kind;
}

// Columns of the estimated errors, where a row has one.
void add_estimates(std::vector<Column<Row>>& columns, const std::vector<Row>& rows) {
    if (std::ranges::none_of(rows, has_estimate)) return;
    columns.push_back({"estimate", [](const Row& row) {
                           if (!row.estimate) return Cell();
                           return Cell(row.estimate->kind == EstimateKind::bound ? "bound"
                                                                                 : "standard");
                       }});
    columns.push_back({"estimated error", [](const Row& row) {
                           return row.estimate ? Cell(row.estimate->estimated) : Cell();
                       }});
    columns.push_back({"estimated / error", [](const Row& row) {
                           const bool errs = row.estimate && row.estimate->error > 0.0;
                           return errs ? Cell(row.estimate->estimated / row.estimate->error)
                                       : Cell();
                       }});
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
    std::vector<Column<Row>> columns = {
        {"setting", [](const Row& row) { return row.setting.name; }},
        {"axis", [](const Row& row) { return axis_name(row.setting.axis); }},
        {"options", [](const Row& row) { return row.setting.options; }},
        {"pareto", front_text},
        {"frame [ms]", [](const Row& row) { return row.speed.frame_ms; }},
        {"times default", [](const Row& row) { return row.speed.relative; }},
        {"times default 5 %", [](const Row& row) { return row.speed.relative_p5; }},
        {"times default 95 %", [](const Row& row) { return row.speed.relative_p95; }},
        {"noise", [](const Row& row) { return row.speed.noise; }},
        {"frames", [](const Row& row) { return row.speed.frames; }},
        {"scaled", [](const Row& row) { return row.speed.scaled ? "by pixels" : ""; }}};
    for (const std::string& stage : stage_names(rows)) {
        columns.push_back(stage_column(stage + " [ms]", stage));
    }
    columns.insert(
        columns.end(),
        {count_column("k", &ReportSpeed::k),
         count_column("k*", &ReportSpeed::useful_k),
         {"k*/k", useful_share},
         {"G evaluations/s", [](const Row& row) { return 1e-9 * row.speed.evaluations_per_s; }},
         {"cut-off", &Row::cut_off},
         {"missed lights", &Row::missed_lights},
         {"error size", error_size_text}});
    if (has_unlike_devices(rows)) {
        columns.push_back({"errors by", [](const Row& row) { return row.gpu->info.name; }});
    }
    add_errors(columns, "R1", &Row::kernels);
    add_errors(columns, "R2", &Row::surfaces);
    add_errors(columns, "R3", &Row::unbounded);
    columns.insert(
        columns.end(),
        {{"rasterised rmse", [](const Row& row) { return row.rasterised.rmse; }},
         {"rasterised 99.9 % rel",
          [](const Row& row) { return row.rasterised.relative.percentile_99_9; }},
         {"rasterised max rel", [](const Row& row) { return row.rasterised.relative.max; }},
         {"tails rmse", [](const Row& row) { return row.tails.rmse; }},
         {"tails relmse", [](const Row& row) { return row.tails.rel_mse; }}});
    add_estimates(columns, rows);
    return make_table(columns, rows);
}

Table report_summary(const std::vector<Row>& rows) {
    std::vector<Column<Row>> columns = {
        {"setting", [](const Row& row) { return row.setting.name; }},
        {"Pareto", front_text},
        {"frame [ms]", [](const Row& row) { return row.speed.frame_ms; }},
        {"x default", [](const Row& row) { return row.speed.relative; }},
        group_column("draw", StageGroup::surfaces),
        group_column("lists", StageGroup::lists),
        group_column("shade", StageGroup::shading),
        count_column("k", &ReportSpeed::k),
        {"k*/k", useful_share},
        {"G eval/s", [](const Row& row) { return 1e-9 * row.speed.evaluations_per_s; }},
        {"R1 max rel", [](const Row& row) { return row.kernels.hdr.relative.max; }},
        {"R1 RMSE", [](const Row& row) { return row.kernels.hdr.rmse; }},
        {"rasterised RMSE", [](const Row& row) { return row.rasterised.rmse; }},
        {"R2 RMSE", [](const Row& row) { return row.surfaces.hdr.rmse; }},
        {"R2 PSNR [dB]", [](const Row& row) { return row.surfaces.hdr.psnr_db; }},
        {"R2 SSIM", [](const Row& row) { return row.surfaces.ssim; }},
        {"R2 FLIP", [](const Row& row) { return row.surfaces.flip.mean; }},
        {"R3 RMSE", [](const Row& row) { return row.unbounded.hdr.rmse; }},
        {"R3 FLIP", [](const Row& row) { return row.unbounded.flip.mean; }}};
    if (std::ranges::any_of(rows, casts_shadows)) {
        const auto shade = std::ranges::find(columns, "shade", &Column<Row>::name);
        columns.insert(shade, group_column("cast", StageGroup::shadows));
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
        {"setting", [](const Row& row) { return row.setting.name; }},
        {"Pareto", [](const Row& row) { return row.tails_front ? "yes" : ""; }},
        {"frame [ms]", [](const Row& row) { return row.speed.frame_ms; }},
        {"x default", [](const Row& row) { return row.speed.relative; }},
        stage_column("cut [ms]", kCutLightTreeStage.name),
        group_column("shade [ms]", StageGroup::shading),
        count_column("k", &ReportSpeed::k),
        {"tails RMSE", [](const Row& row) { return row.tails.rmse; }},
        {"tails relMSE", [](const Row& row) { return row.tails.rel_mse; }},
        {"R3 RMSE", [](const Row& row) { return row.unbounded.hdr.rmse; }}};
    add_estimates(columns, shown);
    columns.push_back({"time", [](const Row& row) { return row.speed.scaled ? "by pixels" : ""; }});
    return make_table(columns, shown);
}

std::string report_notes(const std::vector<Row>& rows) {
    const RenderSettings& s = rows.front().setting.settings;
    return fmt::format(
        "Errors are measured on pictures of {} pixels (--error-width sets this), times on {}.\n"
        "x default: frame time relative to the default's, median over pairs of frames.\n"
        "k: lights evaluated per surface pixel. k*: those of them in range. k*/k: the useful "
        "share.\n"
        "R1: against float64 shading of the stored surfaces, the kernels' error. rasterised: of "
        "the "
        "unquantised surfaces.\n"
        "R2: against float64 ray casting, the error of the whole picture. R3: as R2, with lights "
        "of unlimited range.\n{}",
        error_size_text(rows.front()), size_text(s.width, s.height),
        std::ranges::any_of(rows, has_estimate)
            ? "estimated error: a bound (the median over the pixels) or a standard error (the root "
              "mean square); estimated / error: its ratio to the same of the actual error.\n"
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
    return out;
}

}  // namespace kilolux
