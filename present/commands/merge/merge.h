// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/cli/setting.h"
#include "present/commands/merge/results.h"
#include "present/program.h"

namespace kilolux {

void visit_settings(MergeOptions& options, const SettingVisitor& visit);
void add_merge_options(CLI::App& command, MergeOptions& options);
void add_merge_command(Program& program);

}  // namespace kilolux
