// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/lighting/coarse_light_lists.h"
#include "host/render/path.h"
#include "raster/forward_pass.h"

namespace kilolux {

/// What forward shading compiles in for a plan. `opaque`: see ForwardFeatures.
ForwardFeatures forward_features(const ScenePlan& plan, bool clustered, bool opaque);

/// The lights as forward passes take them; with `lists`, by coarse cluster. Neither is owned.
ForwardLights forward_lights(const Sample& sample, float ambient, const HostCoarseLists* lists);

/// Surfaces that blend, drawn by OpenGL over a lit picture.
class BlendedPass {
 public:
    /// `clustered`: draw() gets lists.
    BlendedPass(const PathContext& context, bool clustered);

    /// Draws them over `radiance`, behind what `targets` show. `lists`: null for every light.
    /// Blocks.
    void draw(const Sample& sample, const Radiance& radiance, const GBufferTargets& targets,
              const HostCoarseLists* lists, Measured out);

 private:
    PathContext context_;
    ForwardPass pass_;
};

}  // namespace kilolux
