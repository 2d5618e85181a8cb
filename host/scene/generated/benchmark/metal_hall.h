// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// Rough metals under points: microfacet lobes without mirror images.
Scene make_metal_hall();

}  // namespace kilolux
