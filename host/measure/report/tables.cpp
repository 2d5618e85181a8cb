// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/tables.h"

#include <fmt/core.h>

#include <algorithm>

namespace kilolux {
namespace {

// Appends cells to the last row, and to the columns if it is the first one.
class Line {
 public:
    explicit Line(Table& table) : table_(table), first_(table.rows.empty()) {
        table_.rows.emplace_back();
    }
    Line& add(const std::string& column, Cell cell) {
        if (first_) table_.columns.push_back(column);
        table_.rows.back().push_back(std::move(cell));
        return *this;
    }
    Line& counted(const std::string& column, double value) {
        return add(column, value < 0.0 ? Cell() : Cell(value));
    }
    Line& whole(const std::string& column, std::optional<std::uint64_t> value) {
        return add(column, value ? Cell(static_cast<std::int64_t>(*value)) : Cell());
    }

 private:
    Table& table_;
    bool first_;
};

std::string size_text(int width, int height) { return fmt::format("{}x{}", width, height); }

std::vector<std::string> stage_names(const std::vector<ReportRow>& rows) {
    std::vector<std::string> names;
    for (const ReportRow& row : rows) {
        for (const ReportStage& stage : row.speed.stages) {
            if (std::find(names.begin(), names.end(), stage.name) == names.end()) {
                names.push_back(stage.name);
            }
        }
    }
    return names;
}

// Sum of the named stages' medians; empty if none of them ran.
Cell sum_of(const ReportSpeed& speed, const std::vector<std::string>& names) {
    double sum = 0.0;
    bool any = false;
    for (const ReportStage& stage : speed.stages) {
        if (std::find(names.begin(), names.end(), stage.name) == names.end()) continue;
        sum += stage.ms.median;
        any = true;
    }
    return any ? Cell(sum) : Cell();
}

Cell optional_cell(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }

Cell useful_share(const ReportSpeed& s) {
    return s.k > 0.0 && s.useful_k >= 0.0 ? Cell(s.useful_k / s.k) : Cell();
}

void add_errors(Line& line, const std::string& of, const PictureErrors& e) {
    const HdrMetrics& h = e.hdr;
    line.add(of + " max abs", h.absolute.max)
        .add(of + " mean abs", h.absolute.mean)
        .add(of + " 99.9 % abs", h.absolute.percentile_99_9)
        .add(of + " worst pixel", pixel_text(h.absolute))
        .add(of + " max rel", h.relative.max)
        .add(of + " 99.9 % rel", h.relative.percentile_99_9)
        .add(of + " worst rel pixel", pixel_text(h.relative))
        .add(of + " rmse", h.rmse)
        .add(of + " psnr [dB]", h.psnr_db)
        .add(of + " psnr peak", h.psnr_peak)
        .add(of + " relmse", h.rel_mse)
        .whole(of + " nan pixels", h.nan_pixels)
        .whole(of + " infinite pixels", h.infinite_pixels)
        .whole(of + " negative pixels", h.negative_pixels)
        .whole(of + " bit-different pixels", h.different_pixels)
        .add(of + " max codes", e.codes.difference.max)
        .whole(of + " code-different pixels", e.codes.different_pixels)
        .add(of + " ssim", optional_cell(e.ssim))
        .add(of + " flip mean", e.flip.mean)
        .add(of + " flip 99.9 %", e.flip.percentile_99_9)
        .add(of + " ldr-flip mean", e.flip_display.mean);
}

std::string front_text(const ReportRow& row) {
    if (row.surfaces_front && row.unbounded_front) return "R2 R3";
    return row.surfaces_front ? "R2" : (row.unbounded_front ? "R3" : "");
}

Plot time_plot(const char* title, const char* y_label, const std::string& caption) {
    Plot plot;
    plot.title = title;
    plot.subtitle = caption;
    plot.x_label = "frame [ms] (ratio to the default's in pairs of frames; bars: 5 % to 95 %)";
    plot.y_label = y_label;
    plot.log_x = plot.log_y = true;
    plot.pareto_front = true;
    return plot;
}

void add_point(Plot& plot, const ReportRow& row, double standard_ms, double error) {
    const std::string name = axis_name(row.setting.axis);
    auto found = std::find_if(plot.series.begin(), plot.series.end(),
                              [&](const PlotSeries& s) { return s.name == name; });
    if (found == plot.series.end()) {
        plot.series.push_back({name, {}, PlotStyle::points});
        found = plot.series.end() - 1;
    }
    const ReportSpeed& s = row.speed;
    PlotPoint point{s.relative * standard_ms, error, row.setting.name};
    point.x_low = s.relative_p5 * standard_ms;
    point.x_high = s.relative_p95 * standard_ms;
    found->points.push_back(std::move(point));
}

}  // namespace

Table report_table(const std::vector<ReportRow>& rows) {
    Table table;
    const std::vector<std::string> stages = stage_names(rows);
    for (const ReportRow& row : rows) {
        const ReportSpeed& s = row.speed;
        Line line(table);
        line.add("setting", row.setting.name)
            .add("axis", std::string(axis_name(row.setting.axis)))
            .add("options", row.setting.options)
            .add("pareto", front_text(row))
            .add("frame [ms]", s.frame_ms.median)
            .add("times default", s.relative)
            .add("times default 5 %", s.relative_p5)
            .add("times default 95 %", s.relative_p95)
            .add("noise", s.noise)
            .whole("frames", s.frame_ms.count)
            .add("scaled", std::string(s.scaled ? "by pixels" : ""));
        for (const std::string& stage : stages) line.add(stage + " [ms]", sum_of(s, {stage}));
        line.counted("k", s.k)
            .counted("k*", s.useful_k)
            .add("k*/k", useful_share(s))
            .add("G evaluations/s", 1e-9 * s.evaluations_per_s)
            .add("cut-off", row.cut_off)
            .whole("missed lights", row.missed_lights)
            .add("error size", size_text(row.picture.width, row.picture.height));
        add_errors(line, "R1", row.kernels);
        add_errors(line, "R2", row.surfaces);
        add_errors(line, "R3", row.unbounded);
        line.add("drawn rmse", row.drawn.rmse)
            .add("drawn 99.9 % rel", row.drawn.relative.percentile_99_9)
            .add("drawn max rel", row.drawn.relative.max);
    }
    return table;
}

Table report_summary(const std::vector<ReportRow>& rows) {
    Table table;
    for (const ReportRow& row : rows) {
        const ReportSpeed& s = row.speed;
        const PictureErrors& e = row.surfaces;
        Line line(table);
        line.add("setting", row.setting.name)
            .add("Pareto", front_text(row))
            .add("frame [ms]", s.frame_ms.median)
            .add("x default", s.relative)
            .add("draw", sum_of(s, {"geometry", "gbuffer_bridge"}))
            .add("lists", sum_of(s, {"prepare_lights", "build_clusters", "cull_lights",
                                     "bin_pixels", "refine_lights"}))
            .add("shade", sum_of(s, {"shade", "forward", "forward_plus"}))
            .counted("k", s.k)
            .add("k*/k", useful_share(s))
            .add("G eval/s", 1e-9 * s.evaluations_per_s)
            .add("R1 max rel", row.kernels.hdr.relative.max)
            .add("R1 RMSE", row.kernels.hdr.rmse)
            .add("drawn RMSE", row.drawn.rmse)
            .add("R2 RMSE", e.hdr.rmse)
            .add("R2 PSNR [dB]", e.hdr.psnr_db)
            .add("R2 SSIM", optional_cell(e.ssim))
            .add("R2 FLIP", e.flip.mean)
            .add("R3 RMSE", row.unbounded.hdr.rmse)
            .add("R3 FLIP", row.unbounded.flip.mean);
    }
    return table;
}

std::string report_notes(const std::vector<ReportRow>& rows) {
    const RenderSettings& s = rows.front().setting.settings;
    const RgbImage& picture = rows.front().picture;
    return fmt::format(
        "Errors are measured on pictures of {} pixels (--error-width sets this), times on {}.\n"
        "x default: frame time relative to the default's, median over pairs of frames.\n"
        "k: lights evaluated per drawn pixel. k*: those of them in range. k*/k: the useful share.\n"
        "R1: against float64 shading of the stored surfaces, the kernels' error. drawn: of the "
        "unquantised surfaces.\n"
        "R2: against float64 ray casting, the error of the whole picture. R3: as R2, with lights "
        "of unlimited range.\n",
        size_text(picture.width, picture.height), size_text(s.width, s.height));
}

Plot surfaces_plot(const std::vector<ReportRow>& rows, const std::string& caption) {
    Plot plot = time_plot("Speed against error: the picture asked for, in float64 (R2)",
                          "RMSE against R2 [radiance]", caption);
    for (const ReportRow& row : rows) {
        if (row.setting.axis == SettingAxis::cut_off) continue;
        add_point(plot, row, rows.front().speed.frame_ms.median, row.surfaces.hdr.rmse);
    }
    return plot;
}

Plot unbounded_plot(const std::vector<ReportRow>& rows, const std::string& caption) {
    Plot plot = time_plot("Speed against error: lights without a range, in float64 (R3)",
                          "RMSE against R3 [radiance]", caption);
    for (const ReportRow& row : rows) {
        if (row.setting.axis != SettingAxis::cut_off && &row != &rows.front()) continue;
        add_point(plot, row, rows.front().speed.frame_ms.median, row.unbounded.hdr.rmse);
    }
    return plot;
}

}  // namespace kilolux
