// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

// CMakeLists.txt reads these lines.
#define KILOLUX_VERSION_MAJOR 0
#define KILOLUX_VERSION_MINOR 1
#define KILOLUX_VERSION_PATCH 0
/// To compare: #if KILOLUX_VERSION >= KILOLUX_MAKE_VERSION(0, 1, 0)
#define KILOLUX_MAKE_VERSION(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
#define KILOLUX_VERSION \
    KILOLUX_MAKE_VERSION(KILOLUX_VERSION_MAJOR, KILOLUX_VERSION_MINOR, KILOLUX_VERSION_PATCH)

namespace kilolux {

/// The version of the program, or of the library that is linked, "0.1.0".
std::string version();

}  // namespace kilolux
