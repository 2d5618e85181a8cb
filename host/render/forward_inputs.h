// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/lighting/coarse_stages.h"
#include "host/render/render_context.h"
#include "raster/forward_pass.h"

namespace kilolux {

/// What forward shading compiles in for a plan. `opaque`: see ForwardFeatures.
ForwardFeatures forward_features(const ScenePlan& plan, bool clustered, bool opaque);

/// The lights as forward passes take them; with `lists`, by coarse cluster. Neither is owned.
ForwardLights forward_lights(const LightRows& rows, float ambient, const HostCoarseLists* lists);

}  // namespace kilolux
