// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/row.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "host/base/error.h"
#include "host/base/gbuffer_layout.h"
#include "host/measure/bench/renderer_names.h"

namespace kilolux {
namespace {

Cell cell_of(double value) { return value; }
Cell cell_of(const std::string& text) { return text; }
template <std::integral Integer>
Cell cell_of(Integer value) {
    return static_cast<std::int64_t>(value);
}

void read(std::string& text, const std::string& field) { text = field; }
template <typename Number>
void read(Number& number, const std::string& field) {
    const char* const end = field.data() + field.size();
    const auto result = std::from_chars(field.data(), end, number);
    if (result.ec != std::errc() || result.ptr != end)
        throw Error(fmt::format("'{}', must be a number", field));
}

struct Column {
    const char* name;
    Cell (*cell)(const BenchRow& row);
    void (*read)(BenchRow& row, const std::string& field);  // null: follows from others
};

// A column that holds one member, to which `Member` refers.
template <auto Member>
constexpr Column stored(const char* name) {
    return {name, [](const BenchRow& row) { return cell_of(Member(row)); },
            [](BenchRow& row, const std::string& field) { read(Member(row), field); }};
}

template <double (BenchRow::*Value)() const>
constexpr Column derived(const char* name) {
    return {name, [](const BenchRow& row) { return Cell((row.*Value)()); }, nullptr};
}

#define MEMBER(path)                                     \
    stored < [](auto& row) -> auto& { return row.path; } \
    >

constexpr Column kColumns[] = {
    {"renderer", [](const BenchRow& r) { return Cell(renderer_name(r.point.renderer)); },
     [](BenchRow& r, const std::string& field) { r.point.renderer = renderer_of_name(field); }},
    MEMBER(point.resolution[0])("width"),
    MEMBER(point.resolution[1])("height"),
    MEMBER(point.lights)("lights"),
    MEMBER(point.grid[0])("tiles_x"),
    MEMBER(point.grid[1])("tiles_y"),
    MEMBER(point.grid[2])("slices_per_octave"),
    MEMBER(point.lanes)("lanes"),
    MEMBER(point.group_height)("group_height"),
    {"gbuffer", [](const BenchRow& r) { return Cell(gbuffer_layout_name(r.point.gbuffer)); },
     [](BenchRow& r, const std::string& field) { r.point.gbuffer = parse_gbuffer_layout(field); }},
    MEMBER(stage)("stage"),
    MEMBER(ms.count)("n"),
    MEMBER(ms.median)("median_ms"),
    MEMBER(ms.p5)("p5_ms"),
    MEMBER(ms.p95)("p95_ms"),
    MEMBER(ms.min)("min_ms"),
    MEMBER(ms.max)("max_ms"),
    MEMBER(ms.mean)("mean_ms"),
    MEMBER(limit_ms)("limit_ms"),
    derived<&BenchRow::ratio>("limit_ratio"),
    MEMBER(bound)("bound"),
    MEMBER(evaluations)("evaluations"),
    derived<&BenchRow::giga_evaluations_per_s>("gigaevaluations_per_s"),
    MEMBER(bytes)("bytes"),
    derived<&BenchRow::gigabytes_per_s>("gigabytes_per_s"),
    MEMBER(k)("k"),
    MEMBER(useful_k)("useful_k"),
    derived<&BenchRow::useful_share>("useful_share"),
    MEMBER(error.max_relative)("max_relative_error"),
    MEMBER(error.different_pixels)("different_pixels"),
    MEMBER(error.pixels)("compared_pixels"),
};

std::vector<std::string> columns() {
    std::vector<std::string> names;
    for (const Column& column : kColumns) names.emplace_back(column.name);
    return names;
}

BenchRow row_of(const std::vector<std::string>& fields) {
    BenchRow row;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        try {
            if (kColumns[i].read) kColumns[i].read(row, fields[i]);
        } catch (const Error& error) {
            throw Error(fmt::format("{} is {}", kColumns[i].name, error.what()));
        }
    }
    return row;
}

// 0 is what has no model or was not counted.
Cell unless_zero(double value) { return value > 0.0 ? Cell(value) : Cell(); }

std::vector<Cell> summary_cells(const BenchRow& r) {
    return {r.stage,
            r.ms.median,
            r.ms.p5,
            r.ms.p95,
            unless_zero(r.limit_ms),
            unless_zero(r.ratio()),
            r.beats_limit() ? "beaten: " + r.bound : r.bound,
            unless_zero(r.giga_evaluations_per_s()),
            unless_zero(r.gigabytes_per_s()),
            r.k,
            r.useful_share(),
            r.error.max_relative,
            cell_of(r.error.different_pixels)};
}

}  // namespace

bool BenchRow::beats_limit() const {
    constexpr std::size_t kFewestFrames = 10;
    constexpr double kLimitNoise = 0.05;  // relative, of the measured limits
    // OpenGL copies faster than the copies that were measured for the limit.
    return stage != "gbuffer_bridge" && limit_ms > 0.0 && ms.count >= kFewestFrames &&
           limit_ms - ms.median > std::max(ms.p95 - ms.p5, kLimitNoise * ms.median);
}

Table bench_table(const std::vector<BenchRow>& rows) {
    Table table;
    table.columns = columns();
    for (const BenchRow& row : rows) {
        std::vector<Cell>& cells = table.rows.emplace_back();
        for (const Column& column : kColumns) cells.push_back(column.cell(row));
    }
    return table;
}

Table bench_summary(const std::vector<BenchRow>& rows) {
    std::vector<SweepPoint> points;
    for (const BenchRow& row : rows) points.push_back(row.point);
    const std::vector<std::string> varying = varying_fields(points);
    Table table;
    table.columns = varying;
    for (const char* name : {"stage", "median [ms]", "p5", "p95", "limit [ms]", "ratio", "bound",
                             "Geval/s", "GB/s", "k", "k*/k", "max rel. error", "bits differ"}) {
        table.columns.emplace_back(name);
    }
    for (const BenchRow& row : rows) {
        std::vector<Cell>& cells = table.rows.emplace_back();
        for (const auto& [name, text] : fields_of(row.point)) {
            const bool shown = std::find(varying.begin(), varying.end(), name) != varying.end();
            if (shown) cells.emplace_back(text);
        }
        for (Cell& cell : summary_cells(row)) cells.push_back(std::move(cell));
    }
    return table;
}

std::string bench_legend() {
    return "limit: least time by the device's measured rates; ratio: limit / median (1 is best).\n"
           "k: lights evaluated a drawn pixel; k*: of those, lights whose range covers the pixel.\n"
           "Geval/s: lights evaluated in full at a pixel (refine_lights: light against box).\n"
           "other: frame time outside of the stages.\n";
}

bool is_bench_table(const TextTable& csv) { return csv.columns == columns(); }

std::vector<BenchRow> bench_rows(const TextTable& csv) {
    std::vector<BenchRow> rows;
    if (csv.columns.empty()) return rows;
    if (!is_bench_table(csv)) throw Error("line 1: is not this version's header");
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
        try {
            rows.push_back(row_of(csv.rows[i]));
        } catch (const Error& error) {
            throw Error(fmt::format("line {}: {}", i + 2, error.what()));
        }
    }
    return rows;
}

}  // namespace kilolux
