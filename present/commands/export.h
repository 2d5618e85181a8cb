// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/cli/options.h"
#include "present/program.h"

namespace kilolux {

struct ExportOptions {
    SharedOptions shared;
    std::filesystem::path output;
    bool operator==(const ExportOptions&) const = default;
};

void visit_settings(ExportOptions& options, const SettingVisitor& visit);
void add_export_options(CLI::App& command, ExportOptions& options);
void add_export_command(Program& program);

}  // namespace kilolux
