// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/program.h"

namespace kilolux {

void add_view_command(Program& program);

}  // namespace kilolux
