// SPDX-License-Identifier: Apache-2.0
#include "host/base/version.h"

namespace kilolux {

std::string version() { return KILOLUX_VERSION; }

}  // namespace kilolux
