// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/program.h"

namespace kilolux {

// One function a subcommand, which registers it: commands/<name>.cpp.
void add_render_command(Program& program);

}  // namespace kilolux
