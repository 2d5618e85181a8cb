// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/row.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "host/base/error.h"
#include "host/base/formats/gbuffer_layout.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/read_text.h"
#include "host/base/text.h"
#include "host/measure/roofline/stages.h"

namespace kilolux {
namespace {

void read(std::string& text, const std::string& field) { text = field; }
template <typename Number>
void read(Number& number, const std::string& field) {
    const auto value = number_of<Number>(field);
    if (!value) throw Error(fmt::format("'{}', must be a number", field));
    number = *value;
}

struct CsvColumn {
    const char* name;
    Cell (*cell)(const BenchRow& row);
    void (*read)(BenchRow& row, const std::string& field);  // null: follows from others
};

// A column that holds one member, to which `Member` refers.
template <auto Member>
constexpr CsvColumn stored(const char* name) {
    return {name, [](const BenchRow& row) { return cell_of(Member(row)); },
            [](BenchRow& row, const std::string& field) { read(Member(row), field); }};
}

template <double (BenchRow::*Value)() const>
constexpr CsvColumn derived(const char* name) {
    return {name, [](const BenchRow& row) { return Cell((row.*Value)()); }, nullptr};
}

#define MEMBER(path)                                     \
    stored < [](auto& row) -> auto& { return row.path; } \
    >

constexpr CsvColumn kColumns[] = {
    {"renderer", [](const BenchRow& r) { return Cell(renderer_name(r.point.renderer)); },
     [](BenchRow& r, const std::string& field) { r.point.renderer = renderer_of_name(field); }},
    MEMBER(point.resolution[0])("width"),
    MEMBER(point.resolution[1])("height"),
    MEMBER(point.lights)("lights"),
    MEMBER(point.grid[0])("tiles_x"),
    MEMBER(point.grid[1])("tiles_y"),
    MEMBER(point.grid[2])("slices_per_octave"),
    MEMBER(point.lanes)("lanes"),
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
    // Missing in tables of versions that did not count shadows.
    MEMBER(shafts)("shafts"),
    MEMBER(saved_rays)("saved_rays"),
};
constexpr std::size_t kShadowColumns = 2;

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

// An empty cell for 0: the stage has no model or was not counted.
Cell unless_zero(double value) { return value > 0.0 ? Cell(value) : Cell(); }

bool casts(const BenchRow& row) { return row.shafts > 0.0; }

}  // namespace

bool BenchRow::beats_limit() const {
    constexpr std::size_t kFewestFrames = 10;
    constexpr double kLimitNoise = 0.05;  // relative, of the measured limits
    const StageInfo* info = stage_info(stage);
    return info && !info->opengl_copies && limit_ms > 0.0 && ms.count >= kFewestFrames &&
           limit_ms - ms.median > std::max(ms.p95 - ms.p5, kLimitNoise * ms.median);
}

Table bench_table(const std::vector<BenchRow>& rows) {
    std::vector<Column<BenchRow>> columns;
    for (const CsvColumn& column : kColumns) columns.push_back({column.name, column.cell});
    return make_table(columns, rows);
}

Table bench_summary(const std::vector<BenchRow>& rows) {
    using R = BenchRow;
    std::vector<Column<R>> columns;
    for (const std::string& field : varying_fields(rows)) {
        columns.push_back({field, [field](const R& r) { return field_text(r.point, field); }});
    }
    columns.insert(
        columns.end(),
        {{"stage", &R::stage},
         {"median [ms]", [](const R& r) { return r.ms.median; }},
         {"p5", [](const R& r) { return r.ms.p5; }},
         {"p95", [](const R& r) { return r.ms.p95; }},
         {"limit [ms]", [](const R& r) { return unless_zero(r.limit_ms); }},
         {"ratio", [](const R& r) { return unless_zero(r.ratio()); }},
         {"bound", [](const R& r) { return r.beats_limit() ? "beaten: " + r.bound : r.bound; }},
         {"Geval/s", [](const R& r) { return unless_zero(r.giga_evaluations_per_s()); }},
         {"GB/s", [](const R& r) { return unless_zero(r.gigabytes_per_s()); }},
         {"k", &R::k},
         {"k*/k", &R::useful_share},
         {"max rel. error", [](const R& r) { return r.error.max_relative; }},
         {"bits differ", [](const R& r) { return r.error.different_pixels; }}});
    if (std::ranges::any_of(rows, casts)) {
        columns.insert(
            columns.end(),
            {{"rays", [](const R& r) { return casts(r) ? Cell(r.evaluations) : Cell(); }},
             {"rays saved", [](const R& r) { return unless_zero(r.saved_rays); }},
             {"shafts", [](const R& r) { return unless_zero(r.shafts); }}});
    }
    return make_table(columns, rows);
}

std::string bench_legend(const std::vector<BenchRow>& rows) {
    std::string out =
        "limit: least time by the device's measured rates; ratio: limit / median (1 is best).\n"
        "k: lights evaluated a surface pixel; k*: of those, lights whose range covers the pixel.\n"
        "Geval/s: lights evaluated in full at a pixel (refine_lights: light against box).\n"
        "other: frame time outside of the stages.\n";
    if (std::ranges::none_of(rows, casts)) return out;
    return out +
           "rays: shadow rays; saved: of the pairs of a pixel and a listed light, those that need "
           "none, as the light is\nbehind the surface, out of range or not picked. shafts: walks "
           "through the hierarchy. Geval/s of cast_shadows: rays.\n";
}

bool is_bench_table(const TextTable& csv) {
    std::vector<std::string> all = bench_table({}).columns;
    if (csv.columns == all) return true;
    all.resize(all.size() - kShadowColumns);
    return csv.columns == all;
}

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

std::string shared_fields(const std::vector<BenchRow>& rows) {
    const std::vector<std::string> varying = varying_fields(rows);
    std::string out;
    for (const auto& [field, text] : fields_of(rows.front().point)) {
        const bool varies = std::ranges::count(varying, field) > 0;
        if (!varies && text != "auto") out += fmt::format(", {} {}", field, text);
    }
    return out;
}

std::vector<std::string> varying_fields(const std::vector<BenchRow>& rows) {
    std::vector<SweepPoint> points;
    for (const BenchRow& row : rows) points.push_back(row.point);
    return varying_fields(points);
}

std::vector<BenchRow> complete_points(std::vector<BenchRow> rows) {
    while (!rows.empty() && rows.back().stage != kFrameStage.name) rows.pop_back();
    return rows;
}

BenchLog::BenchLog(std::filesystem::path file, bool resume) : file_(std::move(file)) {
    if (!resume || !std::filesystem::exists(file_)) return;
    const std::string text = read_text(file_);
    try {
        rows_ = complete_points(bench_rows(parse_csv(whole_lines(text))));
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file_.string(), error.what()));
    }
}

std::vector<BenchRow> BenchLog::rows_of(const SweepPoint& point) const {
    std::vector<BenchRow> rows;
    std::ranges::copy_if(rows_, std::back_inserter(rows),
                         [&](const BenchRow& row) { return row.point == point; });
    return rows;
}

void BenchLog::append(const std::vector<BenchRow>& rows, const std::function<void()>& begin) {
    if (rows_.empty() && begin) {
        std::error_code none;
        std::filesystem::remove(file_, none);
        begin();
    }
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    write_atomically(file_, to_csv(bench_table(rows_)));
}

}  // namespace kilolux
