// SPDX-License-Identifier: Apache-2.0
// What reports and merged reports share.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/measure/report/run.h"
#include "present/program.h"

namespace kilolux {

/// Scene, lights, sizes and device of a report's context, for plots and pictures.
std::string report_caption(const nlohmann::ordered_json& context);

/// The map of a setting's errors in the folder of a report.
std::filesystem::path error_map_file(const std::filesystem::path& folder, std::string setting);

/// Warns where another setting beats the default; with `must_hold`, throws ComparisonFailed.
void judge_default(const std::vector<ReportRow>& rows, bool must_hold);

void add_report_command(Program& program);

}  // namespace kilolux
