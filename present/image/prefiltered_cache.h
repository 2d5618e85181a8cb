// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "host/scene/lights/prefiltered_environment.h"

namespace kilolux {

/// Returns prefiltered(environment), which takes seconds. The last eight results are kept in
/// cache_folder(), and used only where they are whole, of the same light, and made by the same
/// `commit`.
PrefilteredEnvironment kept_prefiltered(const Environment& environment, std::string_view commit);

}  // namespace kilolux
