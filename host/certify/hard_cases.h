// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/certify/findings.h"
#include "host/gpu/device.h"
#include "host/measure/bench/table.h"

namespace kilolux {

/// A numerically hard case, or a metamorphic test.
struct HardCase {
    std::string_view label;                                     // "1" .. "34", "M1" .. "M8"
    std::string_view name;                                      // "slice-boundaries"
    std::string_view topic;                                     // what is made hard
    std::string_view threshold;                                 // what must hold
    void (*run)(const Gpu& gpu, Findings& findings) = nullptr;  // at the lane width of `gpu`
};

/// All of them, in order. Needs no device.
std::span<const HardCase> hard_cases();

/// A case with what it found over the lane widths that it ran at.
struct HardCaseRow {
    HardCase hard_case;
    std::vector<int> lanes;
    Findings findings;  // the worst over the widths
    std::string error;  // of a case that could not run
    bool passed() const { return error.empty() && findings.passed(); }
};

/// Runs every case at every lane width, one after the other. A case that throws fails with the
/// error's text. Calls `step` after each case at each width; exceptions of `step` are passed on.
std::vector<HardCaseRow> run_hard_cases(const Gpu& gpu, std::span<const HardCase> cases,
                                        std::span<const int> lanes,
                                        const std::function<void()>& step);

/// case | name | tried | worst error (limit) | threshold | lanes | pass
Table hard_case_table(const std::vector<HardCaseRow>& rows);

/// A finding as text: "missed lights: 0 of 12000"; "|d|/E: 3.1e-07 (1e-05)".
std::string finding_text(const Finding& finding);

}  // namespace kilolux
