// SPDX-License-Identifier: Apache-2.0
// What reports and merged reports share.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/measure/report/run.h"
#include "present/cli/options.h"
#include "present/commands/error_budget_options.h"
#include "present/program.h"

namespace kilolux {

struct ReportOptions {
    SharedOptions shared;
    std::optional<int> warm_up;
    std::optional<int> frames;
    std::filesystem::path output;   // folder; empty: the table on standard output only
    std::vector<std::string> axes;  // by axis_name(); empty: all
    bool json = false;
    bool quick = false;
    bool check_default = false;
    bool mixed_devices = false;
    std::vector<std::string> devices;  // by index, where there are several
    Shard shard;                       // of the settings
    BudgetOptions budget;
    bool operator==(const ReportOptions&) const = default;
};

void visit_settings(ReportOptions& options, const SettingVisitor& visit);

/// Scene, lights, sizes and device of a report's context, for plots and pictures.
std::string report_caption(const nlohmann::ordered_json& context);

/// The map of a setting's errors in the folder of a report.
std::filesystem::path error_map_file(const std::filesystem::path& folder, std::string setting);

/// Warns where another setting beats the default; with `must_hold`, throws ComparisonFailed.
void judge_default(const std::vector<ReportRow>& rows, bool must_hold);

void add_report_command(Program& program);

}  // namespace kilolux
