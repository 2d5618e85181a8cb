// SPDX-License-Identifier: Apache-2.0
// `kilolux report --hard-cases`: the numerically hard cases as a table.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/certify/hard_case.h"

namespace kilolux {

struct HardCaseOptions {
    std::string device;                         // as --device
    std::vector<int> lanes = {1, 2, 4, 8, 16};  // widths that every case runs at
    std::vector<std::string> only;              // labels, e.g. "7", "M3"; empty: all
    std::filesystem::path output;  // folder for hard_cases.csv, .json, .md; empty: none
    bool json = false;             // JSON instead of a Markdown table on stdout
    bool quiet = false;            // no progress bar
};

/// Runs the cases and prints the table. Returns whether all passed. Throws UsageError when `only`
/// names no case, Error when a device or a file fails.
bool report_hard_cases(const HardCaseOptions& options);

/// {"device": {...}, "passed": bool, "cases": [{"case", "name", "tried", "threshold", "lanes",
/// "passed", "error", "findings": [{"what", "worst", "limit", "checked", "where"}]}]}.
/// A limit of null: reported, not judged. An infinite worst, as of NaN, is null.
nlohmann::ordered_json hard_cases_json(const DeviceInfo& device,
                                       const std::vector<HardCaseRow>& rows);

}  // namespace kilolux
