// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/picture_files.h"
#include "present/program.h"

namespace kilolux {

void add_render_options(CLI::App& command, RenderOptions& options);
void add_render_command(Program& program);

}  // namespace kilolux
