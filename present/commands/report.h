// SPDX-License-Identifier: Apache-2.0
// What the parts of `kilolux report` share.
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
    std::filesystem::path output;     // folder; empty: the table on standard output only
    std::vector<std::string> trades;  // words of report_trade_names(); empty: all
    bool json = false;
    bool quick = false;
    BudgetOptions budget;
};

/// Registers the shared options and the report's own.
void add_report_options(CLI::App& command, ReportOptions& options);

/// Words of --trades, in Trade's order without `none`.
std::vector<std::string> report_trade_names();

/// What a report has found.
struct Report {
    nlohmann::ordered_json context;
    std::vector<ReportRow> rows;
};

/// Writes report.csv, report.json, report.md, the plots, and pictures of the worst pixels to the
/// folder of -o.
void write_report(const ReportOptions& options, const Report& report, ReportRun& run);

/// The document of --json and report.json.
nlohmann::ordered_json report_json(const Report& report);

}  // namespace kilolux
