// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/certify/findings.h"
#include "host/gpu/device.h"
#include "host/measure/bench/table.h"

namespace kilolux {

/// A numerically hard case: what is tried on one device at one lane width, and how well it went.
struct HardCase {
    std::string label;      // "1" .. "30"; metamorphic tests "M1" .. "M8"
    std::string name;       // a word or three
    std::string tried;      // what is tried, in a sentence
    std::string threshold;  // what must hold
    bool needs_gl = false;
    void (*run)(const Gpu& gpu, Findings& findings) = nullptr;
};

/// All of them, in order. Needs no device.
std::vector<HardCase> hard_cases();

/// A case with what it found over the lane widths that it ran at.
struct HardCaseRow {
    HardCase hard_case;
    std::vector<int> lanes;
    std::vector<Finding> findings;  // the worst over the widths
    std::string error;              // of a case that could not run
    bool passed = false;
};

/// Runs every case at every lane width, one after the other. A case that throws fails with the
/// error's text. `only`: labels to run; empty: all. Calls `step` after each case at each width;
/// what that throws comes out. Throws UsageError when `only` names no case.
std::vector<HardCaseRow> run_hard_cases(const Gpu& gpu, std::span<const int> lanes,
                                        std::span<const std::string> only = {},
                                        const std::function<void()>& step = {});

/// case | name | tried | worst error | threshold | lanes | pass
Table hard_case_table(const std::vector<HardCaseRow>& rows);

/// A finding as text: "missed lights 0 of 12000"; "|d|/E 3.1e-7 (at most 1e-5)".
std::string finding_text(const Finding& finding);

}  // namespace kilolux
