// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kilolux {

/// The folder of the sources, and the program under test.
std::string source_root();
std::string program_file();

}  // namespace kilolux
