// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// Trees with lanterns: points of short range.
Scene make_lantern_forest();

}  // namespace kilolux
