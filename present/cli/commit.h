// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kilolux {

/// The commit that the program was built from, with "-dirty" after it for local changes; "unknown"
/// without git. commit.cmake writes it at every build.
std::string commit();

/// The compiler, the kind of build and the versions of libraries.
std::string built_with();

}  // namespace kilolux
