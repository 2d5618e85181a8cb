// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include "host/base/error.h"
#include "host/certify/hard_case.h"

namespace kilolux {
namespace {

std::string number(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 3);
    return {text, end.ptr};
}

bool is_count(const Finding& f) { return f.limit == 0.0 && f.worst == std::floor(f.worst); }

// The worst of two runs of a case at different lane widths.
void merge(Findings& into, const Findings& from) {
    for (const Finding& f : from.all()) {
        into.at_most(f.what, Worst{f.worst, f.checked, f.where}, f.limit);
    }
}

void run_row(HardCaseRow& row, const Gpu& gpu, int lanes) {
    Findings merged;
    for (const Finding& f : row.findings) {
        merged.at_most(f.what, Worst{f.worst, f.checked, f.where}, f.limit);
    }
    Findings found;
    try {
        row.hard_case.run(gpu.with_lanes(lanes), found);
    } catch (const std::exception& error) {
        row.error = std::to_string(lanes) + " lanes: " + error.what();
    }
    merge(merged, found);
    row.lanes.push_back(lanes);
    row.findings = merged.all();
    row.passed = row.error.empty() && merged.passed();
}

std::string findings_text(const HardCaseRow& row) {
    std::string text = row.error;
    for (const Finding& f : row.findings) text += (text.empty() ? "" : "; ") + finding_text(f);
    return text;
}

std::string lanes_text(const std::vector<int>& lanes) {
    std::string text;
    for (const int width : lanes) text += (text.empty() ? "" : ", ") + std::to_string(width);
    return text;
}

}  // namespace

std::string finding_text(const Finding& f) {
    std::string text = f.what + ": " + number(f.worst);
    if (is_count(f) && f.checked > 1) text += " of " + std::to_string(f.checked);
    if (f.limit > 0.0 && std::isfinite(f.limit)) text += " (" + number(f.limit) + ")";
    if (!f.passed()) text += " FAILED" + (f.where.empty() ? "" : " at " + f.where);
    return text;
}

std::vector<HardCaseRow> run_hard_cases(const Gpu& gpu, std::span<const int> lanes,
                                        std::span<const std::string> only,
                                        const std::function<void()>& step) {
    std::vector<HardCaseRow> rows;
    for (const HardCase& hard_case : hard_cases()) {
        const bool wanted =
            only.empty() || std::find(only.begin(), only.end(), hard_case.label) != only.end();
        if (wanted) rows.push_back({hard_case, {}, {}, {}, false});
    }
    if (rows.empty()) throw UsageError("hard cases: none of the labels is 1..30 or M1..M8");
    for (HardCaseRow& row : rows) {
        for (const int width : lanes) {
            run_row(row, gpu, width);
            if (step) step();
        }
    }
    return rows;
}

Table hard_case_table(const std::vector<HardCaseRow>& rows) {
    Table table{{"case", "name", "tried", "worst error (limit)", "threshold", "lanes", "pass"}, {}};
    for (const HardCaseRow& row : rows) {
        const HardCase& c = row.hard_case;
        table.rows.push_back({c.label, c.name, c.tried, findings_text(row), c.threshold,
                              lanes_text(row.lanes), std::string(row.passed ? "yes" : "NO")});
    }
    return table;
}

}  // namespace kilolux
