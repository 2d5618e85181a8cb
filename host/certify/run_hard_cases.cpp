// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "host/certify/hard_case.h"

namespace kilolux {
namespace {

bool is_count(const Finding& f) { return f.limit == 0.0 && f.value == std::floor(f.value); }

void run_at(HardCaseRow& row, const Gpu& gpu, int lanes) {
    Findings found;
    try {
        row.hard_case.run(gpu.with_lanes(lanes), found);
    } catch (const std::exception& error) {
        row.error = fmt::format("{} lanes: {}", lanes, error.what());
    }
    row.findings.merge(found);
    row.lanes.push_back(lanes);
}

std::string findings_text(const HardCaseRow& row) {
    std::string text = row.error;
    for (const Finding& f : row.findings.all()) {
        text += (text.empty() ? "" : "; ") + finding_text(f);
    }
    return text;
}

}  // namespace

std::string finding_text(const Finding& f) {
    std::string text = fmt::format("{}: {:.3g}", f.what, f.value);
    if (is_count(f) && f.checked > 1) text += fmt::format(" of {}", f.checked);
    if (f.limit > 0.0 && std::isfinite(f.limit)) text += fmt::format(" ({:.3g})", f.limit);
    if (!f.passed()) text += " FAILED" + (f.where.empty() ? "" : " at " + f.where);
    return text;
}

std::vector<HardCaseRow> run_hard_cases(const Gpu& gpu, std::span<const HardCase> cases,
                                        std::span<const int> lanes,
                                        const std::function<void()>& step) {
    std::vector<HardCaseRow> rows;
    for (const HardCase& hard_case : cases) {
        HardCaseRow& row = rows.emplace_back(HardCaseRow{hard_case, {}, {}, {}});
        for (const int width : lanes) {
            run_at(row, gpu, width);
            step();
        }
    }
    return rows;
}

Table hard_case_table(const std::vector<HardCaseRow>& rows) {
    using Row = HardCaseRow;
    return make_table<Row>(
        {{"case", [](const Row& row) { return row.hard_case.label; }},
         {"name", [](const Row& row) { return row.hard_case.name; }},
         {"tried", [](const Row& row) { return row.hard_case.topic; }},
         {"worst error (limit)", findings_text},
         {"threshold", [](const Row& row) { return row.hard_case.threshold; }},
         {"lanes", [](const Row& row) { return fmt::to_string(fmt::join(row.lanes, ", ")); }},
         {"pass", [](const Row& row) { return row.passed() ? "yes" : "NO"; }}},
        rows);
}

}  // namespace kilolux
