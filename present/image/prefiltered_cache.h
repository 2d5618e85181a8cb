// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/lights/prefiltered_environment.h"

namespace kilolux {

/// Returns prefiltered(environment). The results for built-in environments (`name`), which take
/// seconds, are kept in cache_folder(), and used only where they are whole and of the same light.
PrefilteredEnvironment kept_prefiltered(const std::string& name, const Environment& environment);

}  // namespace kilolux
