// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// A wall of rectangular lights.
Scene make_panel_wall();

}  // namespace kilolux
