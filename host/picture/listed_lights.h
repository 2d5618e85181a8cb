// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/picture/frame.h"

namespace kilolux {

/// Whether any light is in lists, so that a pixel evaluates some of them: directional ones are in
/// none.
inline bool lists_lights(const FrameStats& stats) {
    return stats.lights_used > stats.directional_lights;
}

}  // namespace kilolux
