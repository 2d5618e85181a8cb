// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/row.h"

#include <algorithm>
#include <charconv>

#include "host/base/error.h"
#include "host/base/gbuffer_layout.h"

namespace kilolux {
namespace {

const std::vector<std::string>& columns() {
    static const std::vector<std::string> names = {"context",
                                                   "renderer",
                                                   "width",
                                                   "height",
                                                   "lights",
                                                   "tiles_x",
                                                   "tiles_y",
                                                   "slices_per_octave",
                                                   "lanes",
                                                   "group_height",
                                                   "gbuffer",
                                                   "stage",
                                                   "n",
                                                   "median_ms",
                                                   "p5_ms",
                                                   "p95_ms",
                                                   "min_ms",
                                                   "max_ms",
                                                   "mean_ms",
                                                   "limit_ms",
                                                   "limit_ratio",
                                                   "bound",
                                                   "evaluations",
                                                   "gigaevaluations_per_s",
                                                   "bytes",
                                                   "gigabytes_per_s",
                                                   "k",
                                                   "useful_k",
                                                   "useful_share",
                                                   "max_relative_error",
                                                   "different_pixels",
                                                   "compared_pixels"};
    return names;
}

std::int64_t integer(auto value) { return static_cast<std::int64_t>(value); }

std::vector<Cell> cells_of(const BenchRow& r) {
    const SweepPoint& p = r.point;
    return {r.context,
            renderer_name(p.renderer),
            integer(p.resolution[0]),
            integer(p.resolution[1]),
            integer(p.lights),
            integer(p.grid[0]),
            integer(p.grid[1]),
            integer(p.grid[2]),
            integer(p.lanes),
            integer(p.group_height),
            gbuffer_layout_name(p.gbuffer),
            r.stage,
            integer(r.ms.count),
            r.ms.median,
            r.ms.p5,
            r.ms.p95,
            r.ms.min,
            r.ms.max,
            r.ms.mean,
            r.limit_ms,
            r.ratio(),
            r.bound,
            r.evaluations,
            r.giga_evaluations_per_s(),
            r.bytes,
            r.gigabytes_per_s(),
            r.k,
            r.useful_k,
            r.useful_share(),
            r.error.max_relative,
            integer(r.error.different_pixels),
            integer(r.error.pixels)};
}

// Takes a line's fields one after the other, as numbers or texts.
class Fields {
 public:
    explicit Fields(std::string_view line) : fields_(csv_fields(line)) {
        if (fields_.size() != columns().size()) {
            throw Error("has " + std::to_string(fields_.size()) + " fields, must have " +
                        std::to_string(columns().size()));
        }
    }

    std::string text() { return fields_[next_++]; }

    template <typename Number>
    Number number() {
        const std::string& field = fields_[next_++];
        Number value{};
        const char* const end = field.data() + field.size();
        const auto result = std::from_chars(field.data(), end, value);
        if (result.ec != std::errc() || result.ptr != end) {
            throw Error(columns()[next_ - 1] + " is '" + field + "', must be a number");
        }
        return value;
    }

    void skip() { ++next_; }

 private:
    std::vector<std::string> fields_;
    std::size_t next_ = 0;
};

SweepPoint point_of(Fields& fields) {
    SweepPoint p;
    p.renderer = renderer_of_name(fields.text());
    for (int& edge : p.resolution) edge = fields.number<int>();
    p.lights = fields.number<std::uint64_t>();
    for (int& size : p.grid) size = fields.number<int>();
    p.lanes = fields.number<int>();
    p.group_height = fields.number<int>();
    p.gbuffer = parse_gbuffer_layout(fields.text());
    return p;
}

BenchRow row_of(std::string_view line) {
    Fields fields(line);
    BenchRow r;
    r.context = fields.text();
    r.point = point_of(fields);
    r.stage = fields.text();
    r.ms.count = fields.number<std::size_t>();
    for (double* value : {&r.ms.median, &r.ms.p5, &r.ms.p95, &r.ms.min, &r.ms.max, &r.ms.mean}) {
        *value = fields.number<double>();
    }
    r.limit_ms = fields.number<double>();
    fields.skip();
    r.bound = fields.text();
    r.evaluations = fields.number<double>();
    fields.skip();
    r.bytes = fields.number<double>();
    fields.skip();
    r.k = fields.number<double>();
    r.useful_k = fields.number<double>();
    fields.skip();
    r.error.max_relative = fields.number<double>();
    r.error.different_pixels = fields.number<std::uint64_t>();
    r.error.pixels = fields.number<std::uint64_t>();
    return r;
}

}  // namespace

Table bench_table(const std::vector<BenchRow>& rows) {
    Table table;
    table.columns = columns();
    for (const BenchRow& row : rows) table.rows.push_back(cells_of(row));
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
    for (const BenchRow& r : rows) {
        std::vector<Cell> cells;
        for (const auto& [name, text] : fields_of(r.point)) {
            const bool shown = std::find(varying.begin(), varying.end(), name) != varying.end();
            if (shown) cells.emplace_back(text);
        }
        const auto unless_zero = [](double value) { return value > 0.0 ? Cell(value) : Cell(); };
        for (const Cell& cell :
             {Cell(r.stage), Cell(r.ms.median), Cell(r.ms.p5), Cell(r.ms.p95),
              unless_zero(r.limit_ms), unless_zero(r.ratio()), Cell(r.bound),
              unless_zero(r.giga_evaluations_per_s()), unless_zero(r.gigabytes_per_s()), Cell(r.k),
              Cell(r.useful_share()), Cell(r.error.max_relative),
              Cell(integer(r.error.different_pixels))}) {
            cells.push_back(cell);
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::vector<std::string> csv_fields(std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
            fields.back() += line[++i];
        } else if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    return fields;
}

std::vector<BenchRow> parse_bench_csv(std::string_view csv) {
    std::vector<BenchRow> rows;
    for (int number = 1; !csv.empty(); ++number) {
        const std::size_t end = csv.find('\n');
        const std::string_view line = csv.substr(0, end);
        csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
        try {
            if (number > 1) {
                rows.push_back(row_of(line));
            } else if (csv_fields(line) != columns()) {
                throw Error("is not this version's header");
            }
        } catch (const Error& error) {
            throw Error("line " + std::to_string(number) + ": " + error.what());
        }
    }
    return rows;
}

}  // namespace kilolux
