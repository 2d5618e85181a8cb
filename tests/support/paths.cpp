// SPDX-License-Identifier: Apache-2.0
#include "tests/support/paths.h"

namespace kilolux {

std::string source_root() { return KILOLUX_ROOT; }
std::string program_file() { return KILOLUX_PROGRAM; }

}  // namespace kilolux
