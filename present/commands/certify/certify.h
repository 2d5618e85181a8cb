// SPDX-License-Identifier: Apache-2.0
// The common part of the files of `kilolux certify`.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/certify/hard_cases.h"
#include "present/cli/progress.h"
#include "present/cli/setting.h"
#include "present/program.h"

namespace kilolux {

inline constexpr int kLaneWidths[] = {1, 2, 4, 8, 16};

struct CertifyOptions {
    std::string device;
    std::vector<int> lanes{std::begin(kLaneWidths), std::end(kLaneWidths)};
    std::optional<std::set<std::size_t>> cases;  // places in hard_cases(); none: all
    std::set<std::size_t> parts;                 // places in certificate_parts()
    bool isolate = false;
    int jobs = 1;  // processes at once; above 1 they are isolated
    bool resume = false;
    bool quick = false;
    std::vector<std::string> tables;  // --table: certificates to print instead of making one
    std::string output;               // file, "-" for standard output, empty: none
    ProgressKind progress = ProgressKind::automatic;
    bool quiet = false;
    ProgressKind shown_progress() const { return progress_kind(progress, quiet); }
    bool operator==(const CertifyOptions&) const = default;
};

void visit_settings(CertifyOptions& options, const SettingVisitor& visit);

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
