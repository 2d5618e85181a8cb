// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/table_rows.h"

#include <fmt/core.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/measure/report/tables.h"
#include "host/measure/roofline/stages.h"

namespace kilolux {
namespace {

using Row = ReportRow;

constexpr std::string_view kMilliseconds = " [ms]";

double number_in(const std::string& text) {
    const auto number = number_of<double>(text);
    if (!number) throw Error(fmt::format("'{}', must be a number", text));
    return *number;
}

// A column that holds the number to which `Member` refers; empty: the row has none.
struct NumberColumn {
    const char* name;
    double& (*member)(Row& row);
};

constexpr NumberColumn kNumbers[] = {
    {"frame [ms]", [](Row& r) -> double& { return r.speed.frame_ms; }},
    {"times default", [](Row& r) -> double& { return r.speed.relative; }},
    {"times default 5 %", [](Row& r) -> double& { return r.speed.relative_p5; }},
    {"times default 95 %", [](Row& r) -> double& { return r.speed.relative_p95; }},
    {"noise", [](Row& r) -> double& { return r.speed.noise; }},
    {"k", [](Row& r) -> double& { return r.speed.k; }},
    {"k*", [](Row& r) -> double& { return r.speed.useful_k; }},
    {"cut-off", [](Row& r) -> double& { return r.cut_off; }},
    {"R1 max rel", [](Row& r) -> double& { return r.kernels.hdr.relative.max; }},
    {"R1 rmse", [](Row& r) -> double& { return r.kernels.hdr.rmse; }},
    {"R2 rmse", [](Row& r) -> double& { return r.surfaces.hdr.rmse; }},
    {"R2 psnr [dB]", [](Row& r) -> double& { return r.surfaces.hdr.psnr_db; }},
    {"R2 ssim", [](Row& r) -> double& { return r.surfaces.ssim.emplace(); }},
    {"R2 flip mean", [](Row& r) -> double& { return r.surfaces.flip.mean; }},
    {"R3 rmse", [](Row& r) -> double& { return r.unbounded.hdr.rmse; }},
    {"R3 flip mean", [](Row& r) -> double& { return r.unbounded.flip.mean; }},
    {"rasterised rmse", [](Row& r) -> double& { return r.rasterised.rmse; }},
    {"tails rmse", [](Row& r) -> double& { return r.tails.rmse; }},
    {"tails relmse", [](Row& r) -> double& { return r.tails.rel_mse; }},
};

SettingAxis axis_of(const std::string& name) {
    if (name == axis_name(SettingAxis::none)) return SettingAxis::none;
    const std::vector<std::string> names = setting_axis_names();
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) throw Error(fmt::format("'{}', which is no axis", name));
    return static_cast<SettingAxis>(found - names.begin() + 1);
}

void read_size(const std::string& text, RgbImage& picture) {
    const std::vector<std::string_view> edges = split(text, 'x');
    const auto edge = [&](std::size_t i) {
        const auto number = i < edges.size() ? number_of<int>(edges[i]) : std::nullopt;
        if (!number) throw Error(fmt::format("'{}', must be a size", text));
        return *number;
    };
    picture.width = edge(0);
    picture.height = edge(1);
}

// A stage's time; shadows are known by theirs.
void read_stage(const std::string& column, const std::string& text, Row& row) {
    ReportStage stage{column.substr(0, column.size() - kMilliseconds.size()), {}};
    stage.ms.median = number_in(text);
    if (group_of(stage.name) == StageGroup::shadows) row.setting.settings.shadows = Shadows::exact;
    row.speed.stages.push_back(std::move(stage));
}

void read_field(const std::string& column, const std::string& text, Row& row) {
    const auto number = std::ranges::find(kNumbers, column, &NumberColumn::name);
    ErrorEstimate estimate = row.estimate.value_or(ErrorEstimate{});
    if (column == "setting") {
        row.setting.name = text;
    } else if (column == "axis") {
        row.setting.axis = axis_of(text);
    } else if (column == "options") {
        row.setting.options = text;
    } else if (column == "scaled") {
        row.speed.scaled = !text.empty();
    } else if (text.empty()) {
        return;
    } else if (number != std::end(kNumbers)) {
        number->member(row) = number_in(text);
    } else if (column == "G evaluations/s") {
        row.speed.evaluations_per_s = 1e9 * number_in(text);
    } else if (column == "error size") {
        read_size(text, row.picture);
    } else if (column == "estimate") {
        estimate.kind = text == "bound" ? EstimateKind::bound : EstimateKind::standard;
        row.estimate = estimate;
    } else if (column == "estimated error") {
        estimate.estimated = number_in(text);
        row.estimate = estimate;
    } else if (column == "estimated / error") {
        estimate.error = estimate.estimated / number_in(text);
        row.estimate = estimate;
    } else if (column.ends_with(kMilliseconds)) {
        read_stage(column, text, row);
    }
}

}  // namespace

std::vector<Row> report_rows(const TextTable& csv) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
        Row& row = rows.emplace_back();
        for (std::size_t column = 0; column < csv.columns.size(); ++column) {
            try {
                read_field(csv.columns[column], csv.rows[i][column], row);
            } catch (const Error& error) {
                throw Error(
                    fmt::format("line {}: {} is {}", i + 2, csv.columns[column], error.what()));
            }
        }
    }
    return rows;
}

}  // namespace kilolux
