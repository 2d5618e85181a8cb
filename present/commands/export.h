// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/cli/options.h"
#include "present/program.h"

namespace kilolux {

struct ExportOptions {
    SharedOptions shared;
    std::filesystem::path output;
    std::filesystem::path benchmark;  // folder for the benchmark in place of a scene; empty: none
    bool operator==(const ExportOptions&) const = default;
};

void visit_settings(ExportOptions& options, const SettingVisitor& visit);
void add_export_options(CLI::App& command, ExportOptions& options);
void add_export_command(Program& program);

}  // namespace kilolux
