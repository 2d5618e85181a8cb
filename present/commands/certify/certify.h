// SPDX-License-Identifier: Apache-2.0
// The common part of the files of `kilolux certify`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/certify/hard_cases.h"
#include "present/program.h"

namespace kilolux {

/// The results for a device.
struct Certificate {
    std::vector<HardCaseRow> rows;
    nlohmann::ordered_json parts = nlohmann::ordered_json::object();  // see certificate_parts()
};

/// Key of an unfinished certificate: how many processes had not ended.
inline constexpr const char* kUnfinished = "unfinished";

/// Throws ComparisonFailed with the names of the failures.
void require_all_passed(const Certificate& made);

void add_certify_command(Program& program);

}  // namespace kilolux
