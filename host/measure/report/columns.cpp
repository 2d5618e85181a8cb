// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/columns.h"

#include <fmt/core.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/measure/roofline/stages.h"

namespace kilolux {
namespace {

using Row = ReportRow;
using Rows = std::vector<ReportRow>;
using Columns = std::vector<ReportColumn>;

constexpr std::string_view kMilliseconds = " [ms]";

double number_in(const std::string& text) {
    const auto number = number_of<double>(text);
    if (!number) throw Error(fmt::format("'{}', must be a number", text));
    return *number;
}

// A column of the number at the address that `member` returns.
template <typename Member>
ReportColumn number_column(const std::string& name, Member member) {
    ReportColumn out(name, [member](const Row& row) { return *member(row); });
    out.take = [member](Row& row, const std::string& text) { *member(row) = number_in(text); };
    return out;
}

// The same of a count that is negative where nothing was counted.
ReportColumn count_column(const std::string& name, double ReportSpeed::*count) {
    ReportColumn out = number_column(name, [count](auto& row) { return &(row.speed.*count); });
    out.cell = [count](const Row& row) {
        const double value = row.speed.*count;
        return value < 0.0 ? Cell() : Cell(value);
    };
    return out;
}

template <typename Value>
ReportColumn text_column(const std::string& name, Value value,
                         std::function<void(Row&, const std::string&)> take) {
    ReportColumn out(name, value);
    out.take = std::move(take);
    out.is_text = true;
    return out;
}

SettingAxis axis_of(const std::string& name) {
    if (name == axis_name(SettingAxis::none)) return SettingAxis::none;
    const std::vector<std::string> names = setting_axis_names();
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) throw Error(fmt::format("'{}', which is no axis", name));
    return static_cast<SettingAxis>(found - names.begin() + 1);
}

void read_size(Row& row, const std::string& text) {
    const std::vector<std::string_view> edges = split(text, 'x');
    const auto edge = [&](std::size_t i) {
        const auto number = i < edges.size() ? number_of<int>(edges[i]) : std::nullopt;
        if (!number) throw Error(fmt::format("'{}', must be a size", text));
        return *number;
    };
    row.picture.width = edge(0);
    row.picture.height = edge(1);
}

ReportColumn of_all_rows(ReportColumn column) {
    column.of_all_rows = true;
    return column;
}

void add(Columns& to, Columns more) { std::ranges::move(more, std::back_inserter(to)); }

Columns setting_columns() {
    return {text_column(
                "setting", [](const Row& row) { return row.setting.name; },
                [](Row& row, const std::string& text) { row.setting.name = text; }),
            text_column(
                "axis", [](const Row& row) { return axis_name(row.setting.axis); },
                [](Row& row, const std::string& text) { row.setting.axis = axis_of(text); }),
            text_column(
                "options", [](const Row& row) { return row.setting.options; },
                [](Row& row, const std::string& text) { row.setting.options = text; }),
            of_all_rows(text_column("pareto",
                                    [](const Row& row) {
                                        if (row.surfaces_front && row.unbounded_front)
                                            return "R2 R3";
                                        return row.surfaces_front
                                                   ? "R2"
                                                   : (row.unbounded_front ? "R3" : "");
                                    },
                                    {})),
            of_all_rows(number_column("frame [ms]", [](auto& row) { return &row.speed.frame_ms; })),
            number_column("times default", [](auto& row) { return &row.speed.relative; }),
            number_column("times default 5 %", [](auto& row) { return &row.speed.relative_p5; }),
            number_column("times default 95 %", [](auto& row) { return &row.speed.relative_p95; }),
            number_column("noise", [](auto& row) { return &row.speed.noise; }),
            {"frames", [](const Row& row) { return row.speed.frames; }},
            text_column(
                "scaled", [](const Row& row) { return row.speed.scaled ? "by pixels" : ""; },
                [](Row& row, const std::string& text) { row.speed.scaled = !text.empty(); })};
}

bool has_rays(const Row& row) { return row.setting.settings.shadows == Shadows::sampled; }

// Those of sampled shadows.
ReportColumn rays_column() {
    ReportColumn out("shadow rays", [](const Row& row) {
        return has_rays(row) ? Cell(static_cast<double>(row.setting.settings.shadow_rays)) : Cell();
    });
    out.take = [](Row& row, const std::string& text) {
        row.setting.settings.shadows = Shadows::sampled;
        row.setting.settings.shadow_rays = static_cast<int>(number_in(text));
    };
    out.is_shown = [](const Rows& rows) { return std::ranges::any_of(rows, has_rays); };
    return out;
}

Columns count_columns() {
    Columns out = {
        count_column("k", &ReportSpeed::k),
        count_column("k*", &ReportSpeed::useful_k),
        {"k*/k",
         [](const Row& row) {
             const ReportSpeed& s = row.speed;
             return s.k > 0.0 && s.useful_k >= 0.0 ? Cell(s.useful_k / s.k) : Cell();
         }},
        {"G evaluations/s", [](const Row& row) { return 1e-9 * row.speed.evaluations_per_s; }},
        number_column("cut-off", [](auto& row) { return &row.cut_off; }),
        rays_column(),
        {"missed lights", &Row::missed_lights},
        {"error size",
         [](const Row& row) {
             return fmt::format("{}x{}", row.picture.width, row.picture.height);
         }},
        {"errors by", [](const Row& row) { return row.gpu ? row.gpu->info.name : ""; }}};
    const auto column = [&out](std::string_view name) -> ReportColumn& {
        return *std::ranges::find(out, name, &ReportColumn::name);
    };
    column("G evaluations/s").take = [](Row& row, const std::string& text) {
        row.speed.evaluations_per_s = 1e9 * number_in(text);
    };
    column("error size").take = read_size;
    column("errors by").is_shown = [](const Rows& rows) {
        return std::ranges::any_of(rows, [&](const Row& row) {
            return row.gpu && row.gpu->info.name != rows.front().gpu->info.name;
        });
    };
    return out;
}

// The errors against one reference.
Columns error_columns(const std::string& of, PictureErrors Row::*errors) {
    Columns out;
    for (const ErrorMetric& metric : error_metrics()) {
        ReportColumn& column =
            out.emplace_back(fmt::format("{} {}", of, metric.column),
                             [=](const Row& row) { return metric.value(row.*errors); });
        column.take = [=](Row& row, const std::string& text) {
            metric.take(row.*errors, number_in(text));
        };
    }
    out.emplace_back(of + " worst pixel",
                     [=](const Row& row) { return pixel_text((row.*errors).hdr.absolute); });
    out.emplace_back(of + " worst rel pixel",
                     [=](const Row& row) { return pixel_text((row.*errors).hdr.relative); });
    return out;
}

// Makes the row's estimate where it has none.
ErrorEstimate& estimate_of(Row& row) {
    return row.estimate ? *row.estimate : row.estimate.emplace();
}

// A column of a row's estimate, where it has one.
template <typename Value>
ReportColumn estimate_column(const std::string& name, Value value,
                             void (*take)(ErrorEstimate&, const std::string&)) {
    ReportColumn out(
        name, [value](const Row& row) { return row.estimate ? value(*row.estimate) : Cell(); });
    out.take = [take](Row& row, const std::string& text) { take(estimate_of(row), text); };
    out.is_shown = [](const Rows& rows) {
        return std::ranges::any_of(rows, [](const Row& row) { return row.estimate.has_value(); });
    };
    return out;
}

}  // namespace

Columns estimate_columns() {
    using Estimate = ErrorEstimate;
    using Text = const std::string&;
    return {
        estimate_column(
            "estimate",
            [](const Estimate& e) {
                return Cell(e.kind == EstimateKind::bound ? "bound" : "standard");
            },
            [](Estimate& e, Text text) {
                e.kind = text == "bound" ? EstimateKind::bound : EstimateKind::standard;
            }),
        estimate_column(
            "estimated error", [](const Estimate& e) { return Cell(e.estimated); },
            [](Estimate& e, Text text) { e.estimated = number_in(text); }),
        estimate_column(
            "estimated / error",
            [](const Estimate& e) { return e.error > 0.0 ? Cell(e.estimated / e.error) : Cell(); },
            [](Estimate& e, Text text) { e.error = e.estimated / number_in(text); }),
        estimate_column(
            "in 95 % [%]",
            [](const Estimate& e) { return e.within ? Cell(100.0 * *e.within) : Cell(); },
            [](Estimate& e, Text text) { e.within = number_in(text) / 100.0; })};
}

ReportColumn stage_column(const std::string& name, std::string_view stage) {
    ReportColumn out(name, [stage = std::string(stage)](const Row& row) {
        std::optional<double> sum;
        for (const ReportStage& s : row.speed.stages) {
            if (s.name == stage) sum = sum.value_or(0.0) + s.ms.median;
        }
        return sum;
    });
    // Shadows are known by their times.
    out.take = [stage = std::string(stage)](Row& row, const std::string& text) {
        if (group_of(stage) == StageGroup::shadows) row.setting.settings.shadows = Shadows::exact;
        row.speed.stages.push_back({stage, {}});
        row.speed.stages.back().ms.median = number_in(text);
    };
    return out;
}

Columns report_columns(const std::vector<std::string>& stages) {
    Columns out = setting_columns();
    for (const std::string& stage : stages)
        out.push_back(stage_column(stage + std::string(kMilliseconds), stage));
    add(out, count_columns());
    add(out, error_columns("R1", &Row::kernels));
    add(out, error_columns("R2", &Row::surfaces));
    add(out, error_columns("R3", &Row::unbounded));
    add(out, {number_column("rasterised rmse", [](auto& row) { return &row.rasterised.rmse; }),
              number_column("rasterised 99.9 % rel",
                            [](auto& row) { return &row.rasterised.relative.percentile_99_9; }),
              number_column("rasterised max rel",
                            [](auto& row) { return &row.rasterised.relative.max; }),
              number_column("tails rmse", [](auto& row) { return &row.tails.rmse; }),
              number_column("tails relmse", [](auto& row) { return &row.tails.rel_mse; })});
    add(out, estimate_columns());
    return out;
}

std::vector<std::string> stage_names(const Rows& rows) {
    std::vector<std::string> names;
    for (const Row& row : rows) {
        for (const ReportStage& stage : row.speed.stages) {
            if (std::ranges::count(names, stage.name) == 0) names.push_back(stage.name);
        }
    }
    return names;
}

Rows report_rows(const TextTable& csv) {
    const Columns known = report_columns({});
    Rows rows(csv.rows.size());
    for (std::size_t place = 0; place < csv.columns.size(); ++place) {
        const std::string& name = csv.columns[place];
        const auto found = std::ranges::find(known, name, &ReportColumn::name);
        const bool is_stage = found == known.end() && name.ends_with(kMilliseconds);
        if (found == known.end() && !is_stage) continue;
        const ReportColumn column =
            is_stage ? stage_column(name, name.substr(0, name.size() - kMilliseconds.size()))
                     : *found;
        if (!column.take) continue;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::string& text = csv.rows[i][place];
            if (text.empty() && !column.is_text) continue;
            try {
                column.take(rows[i], text);
            } catch (const Error& error) {
                throw Error(fmt::format("line {}: {} is {}", i + 2, name, error.what()));
            }
        }
    }
    return rows;
}

}  // namespace kilolux
