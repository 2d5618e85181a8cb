// SPDX-License-Identifier: Apache-2.0
// Shared by the parts of `kilolux report`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/report/run.h"
#include "present/cli/error_budget_options.h"
#include "present/cli/options.h"

namespace kilolux {

struct ReportOptions {
    SharedOptions shared;
    std::optional<int> warm_up;
    std::optional<int> frames;
    std::filesystem::path output;   // folder; empty: the table on standard output only
    std::vector<std::string> axes;  // by axis_name(); empty: all
    bool json = false;
    bool quick = false;
    BudgetOptions budget;
};

/// Registers the shared options and the report's own.
void add_report_options(CLI::App& command, ReportOptions& options);

struct Report {
    nlohmann::ordered_json context;
    std::string caption;  // scene, lights, sizes, device, for pictures
    std::vector<ReportRow> rows;
};

/// Writes report.csv, report.json, report.md, the plots, and the pictures of errors and worst
/// pixels to the folder of -o.
void write_report(const ReportOptions& options, const Report& report, ReportRun& run);

/// The summary with its notes: report.md.
std::string report_text(const Report& report);

/// The document of --json and report.json.
nlohmann::ordered_json report_json(const Report& report);

}  // namespace kilolux
