// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/flow.h"
#include "host/render/frame.h"
#include "host/render/light_input.h"
#include "host/scene/light_generator.h"
#include "host/scene/scene.h"

namespace kilolux {

/// All lights of a scene, its own and the generated ones, at any time.
class LightSource {
 public:
    /// Says so when it has to give lights of the scene a range. The scene must outlive this.
    LightSource(const Gpu& gpu, const Scene& scene, const LightOptions& generated);

    /// Other generated lights from now on.
    void set_generated(const LightOptions& generated);

    /// Rows relative to the camera at `time` [s]; sets the counts of lights.
    LightRows at(double time, const glm::dvec3& camera_position, FrameStats& stats);

    /// The rows on the device, until the next call.
    LightInput upload(const LightRows& rows);

 private:
    Gpu gpu_;
    const Scene& scene_;
    LightOptions generated_;
    std::vector<SceneLight> own_;     // with ranges
    std::vector<SceneLight> lights_;  // all of them at time_
    std::optional<double> time_;      // none: not made yet
    GrowingBuffer local_, directional_;
};

}  // namespace kilolux
