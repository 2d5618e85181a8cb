// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/lights/prefiltered_environment.h"

namespace kilolux {

/// Returns prefiltered(environment), which takes seconds. The last eight results are kept in
/// cache_folder(), and used only where they are whole and of the same light.
PrefilteredEnvironment kept_prefiltered(const Environment& environment);

}  // namespace kilolux
