// SPDX-License-Identifier: Apache-2.0
// One function a subcommand: <name>.cpp defines it, Program's constructor calls it.
#pragma once

#include "present/program.h"

namespace kilolux {

void add_render_command(Program& program);
void add_view_command(Program& program);
void add_bench_command(Program& program);
void add_report_command(Program& program);
void add_certify_command(Program& program);
void add_info_command(Program& program);
void add_export_command(Program& program);

}  // namespace kilolux
