// SPDX-License-Identifier: Apache-2.0
#include "host/base/version.h"

namespace kilolux {

std::string version() {
    return std::to_string(KILOLUX_VERSION_MAJOR) + "." + std::to_string(KILOLUX_VERSION_MINOR) +
           "." + std::to_string(KILOLUX_VERSION_PATCH);
}

}  // namespace kilolux
