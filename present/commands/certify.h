// SPDX-License-Identifier: Apache-2.0
// What the parts of `kilolux certify` share.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/certify/hard_case.h"

namespace kilolux {

/// {"program": {"version", "commit"}, "device": {...}, "passed": bool, "failed": [labels],
/// "cases": [{"case", "name", "tried", "threshold", "lanes", "passed", "error", "findings":
/// [{"what", "worst", "limit", "checked", "where"}]}]}. A limit of null: reported, not judged. A
/// worst that is infinite or NaN is null. No times: the same result is the same text.
nlohmann::ordered_json certificate_json(const DeviceInfo& device,
                                        const std::vector<HardCaseRow>& rows);

/// Throws ComparisonFailed with the names of the cases that failed.
void require_all_passed(const std::vector<HardCaseRow>& rows);

}  // namespace kilolux
