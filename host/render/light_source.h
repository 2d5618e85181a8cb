// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/flow.h"
#include "host/picture/frame.h"
#include "host/render/light_rows.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// All lights of a scene at `time` [s], its own and the generated ones, each with a range, in the
/// order in which kernels go through them (light_order.h).
std::vector<SceneLight> lights_at(const Scene& scene, const RenderSettings& settings, double time);

/// All lights of a scene, its own and the generated ones, at any time.
class LightSource {
 public:
    /// Lights of the scene without a range get one within settings.range_budget; says so. The scene
    /// must outlive this.
    LightSource(const Gpu& gpu, const Scene& scene, const RenderSettings& settings);

    /// Other generated lights from now on.
    void set_generated(const LightOptions& generated);

    /// Rows relative to the camera at `time` [s], of the scene as it is now; sets the counts of
    /// lights.
    LightRows at(double time, const glm::dvec3& camera_position, FrameStats& stats);

    /// The rows on the device, until the next call.
    LightInput upload(const LightRows& rows);

 private:
    void take_up_changes();

    Gpu gpu_;
    const Scene& scene_;
    std::uint32_t revision_;  // of the scene that own_ are of
    double range_budget_;
    LightOptions generated_;
    std::vector<SceneLight> own_;     // with ranges
    std::vector<SceneLight> lights_;  // all of them at time_
    std::optional<double> time_;      // none: not made yet
    GrowingArray<Light> local_;
    GrowingArray<DirectionalLight> directional_;
};

}  // namespace kilolux
