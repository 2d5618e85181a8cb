// SPDX-License-Identifier: Apache-2.0
// The common part of the files of `kilolux certify`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/certify/hard_case.h"

namespace kilolux {

/// The results for a device.
struct Certificate {
    std::vector<HardCaseRow> rows;
    nlohmann::ordered_json parts = nlohmann::ordered_json::object();  // see certificate_parts()
};

/// {"program": {"version", "commit"}, "device": `device`, "passed": bool, "failed": [labels and
/// names of parts], "cases": [{"case", "name", "tried", "threshold", "lanes", "passed", "error",
/// "findings": [{"what", "worst", "limit", "checked", "where"}]}]} and the parts. A limit of null:
/// reported, not judged. A worst that is infinite or NaN is null. Without "stages" and "tuning" no
/// times: the same result is the same text.
nlohmann::ordered_json certificate_json(const nlohmann::ordered_json& device,
                                        const Certificate& made);

/// Key of an unfinished certificate: how many processes had not ended.
inline constexpr const char* kUnfinished = "unfinished";

/// A certificate's document. Throws Error for a file that is none.
nlohmann::ordered_json read_certificate(const std::string& file);

/// The rows of a certificate; throws nlohmann's exceptions for another document, Error for a case
/// that this program does not know.
std::vector<HardCaseRow> rows_of_json(const nlohmann::ordered_json& certificate);

/// Throws ComparisonFailed with the names of the failures.
void require_all_passed(const Certificate& made);

}  // namespace kilolux
