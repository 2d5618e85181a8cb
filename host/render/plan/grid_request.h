// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/stages/lists/build_clusters.h"

namespace kilolux {

/// The coarse grid for what a camera sees of a scene in `box`: it starts at the near plane and ends
/// with the scene. `pad`: position_pad().
GridRequest grid_request(const GridSettings& settings, const Camera& camera, const Box& box,
                         float pad);

/// How far a G-buffer layout's stored positions may lie from the pixel's ray and depth [m].
float position_pad(uint layout, const Box& box, const Camera& camera);

}  // namespace kilolux
