// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/flow.h"
#include "host/render/frame.h"
#include "host/render/light_input.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// All lights of a scene at `time` [s], its own and then the generated ones, each with a range.
std::vector<SceneLight> lights_at(const Scene& scene, const RenderSettings& settings, double time);

/// All lights of a scene, its own and the generated ones, at any time.
class LightSource {
 public:
    /// Lights of the scene without a range get one within settings.range_budget; says so. The scene
    /// must outlive this.
    LightSource(const Gpu& gpu, const Scene& scene, const RenderSettings& settings);

    /// Takes the scene's own lights anew, after they moved.
    void refresh();

    /// Rows relative to the camera at `time` [s]; sets the counts of lights.
    LightRows at(double time, const glm::dvec3& camera_position, FrameStats& stats) const;

    /// The rows on the device, until the next call.
    LightInput upload(const LightRows& rows);

 private:
    Gpu gpu_;
    const Scene& scene_;
    LightOptions generated_;
    std::vector<SceneLight> own_;  // with ranges
    GrowingBuffer local_, directional_;
};

}  // namespace kilolux
