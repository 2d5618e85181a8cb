// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/certify/certify.h"

namespace kilolux {

/// {"program": {"version", "commit"}, "device": `device`, "passed": bool, "failed": [labels and
/// names of parts], "cases": [{"case", "name", "tried", "threshold", "lanes", "passed", "error",
/// "findings": [{"what", "worst", "limit", "checked", "where"}]}]} and the parts. A limit of null:
/// reported, not judged. A worst that is infinite or NaN is null. Without "stages" and "tuning" no
/// times: the same result is the same text.
nlohmann::ordered_json certificate_json(const nlohmann::ordered_json& device,
                                        const Certificate& made);

/// A certificate's document. Throws Error for a file that is none.
nlohmann::ordered_json read_certificate(const std::string& file);

/// The rows of a certificate; throws nlohmann's exceptions for another document, Error for a case
/// that this program does not know.
std::vector<HardCaseRow> rows_of_json(const nlohmann::ordered_json& certificate);

}  // namespace kilolux
