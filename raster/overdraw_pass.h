// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/scene/camera.h"
#include "raster/scene_programs.h"

namespace kilolux {

/// Counts the fragments that the geometry pass shades and keeps at each pixel: those that were
/// nearest when they came and passed the alpha mask.
class OverdrawPass {
 public:
    /// The GpuScene must outlive this.
    explicit OverdrawPass(const GpuScene& scene);

    /// Draws in the order given, the geometry pass's by default, and returns the counts, width *
    /// height, row 0 on top.
    std::vector<float> count(const Camera& camera, int width, int height,
                             DrawOrder order = DrawOrder::front_to_back) const;

 private:
    const GpuScene& scene_;
    ScenePrograms programs_;
    DrawList draw_list_;
};

}  // namespace kilolux
