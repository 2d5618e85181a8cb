// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "present/cli/progress.h"
#include "present/cli/setting.h"
#include "present/program.h"

namespace kilolux {

struct AssembleOptions {
    std::filesystem::path output;
    std::vector<std::filesystem::path> tiles;
    ProgressKind progress = ProgressKind::automatic;
    bool quiet = false;
    bool operator==(const AssembleOptions&) const = default;
};

void visit_settings(AssembleOptions& options, const SettingVisitor& visit);
void add_assemble_options(CLI::App& command, AssembleOptions& options);
void add_assemble_command(Program& program);

}  // namespace kilolux
