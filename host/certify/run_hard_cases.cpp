// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>

#include "host/certify/hard_case.h"

namespace kilolux {
namespace {

std::string number(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 3);
    return {text, end.ptr};
}

bool is_count(const Finding& f) { return f.limit == 0.0 && f.worst == std::floor(f.worst); }

void run_at(HardCaseRow& row, const Gpu& gpu, int lanes) {
    Findings found;
    try {
        row.hard_case.run(gpu.with_lanes(lanes), found);
    } catch (const std::exception& error) {
        row.error = std::to_string(lanes) + " lanes: " + error.what();
    }
    row.findings.merge(found);
    row.lanes.push_back(lanes);
}

void append(std::string& list, const std::string& separator, const std::string& text) {
    list += (list.empty() ? "" : separator) + text;
}

}  // namespace

std::string finding_text(const Finding& f) {
    std::string text = f.what + ": " + number(f.worst);
    if (is_count(f) && f.checked > 1) text += " of " + std::to_string(f.checked);
    if (f.limit > 0.0 && std::isfinite(f.limit)) text += " (" + number(f.limit) + ")";
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
    Table table{{"case", "name", "tried", "worst error (limit)", "threshold", "lanes", "pass"}, {}};
    for (const HardCaseRow& row : rows) {
        const HardCase& c = row.hard_case;
        std::string findings = row.error;
        for (const Finding& f : row.findings.all()) append(findings, "; ", finding_text(f));
        std::string lanes;
        for (const int width : row.lanes) append(lanes, ", ", std::to_string(width));
        table.rows.push_back({std::string(c.label), std::string(c.name), std::string(c.tried),
                              findings, std::string(c.threshold), lanes,
                              std::string(row.passed() ? "yes" : "NO")});
    }
    return table;
}

}  // namespace kilolux
