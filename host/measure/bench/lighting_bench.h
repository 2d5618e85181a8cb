// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "host/gpu/tuning_store.h"
#include "host/picture/frame.h"
#include "host/render/scene_plan.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// One measurement of the stages from lights to display on a fixed G-buffer.
struct LightingRun {
    FrameStats
        stats;        // stages: the least time of each over the runs; counts as in a rendered frame
    double ms = 0.0;  // sum of the stages' times
    std::uint64_t picture = 0;  // hash of every bit of the radiance
};

/// What a LightingBench measures.
struct LightingRequest {
    ScenePlan plan;
    StoredTuning tuning;
    int runs = 5;           // after one that warms up
    bool geometry = false;  // also the stages geometry and gbuffer_bridge, drawn anew in each run
};

/// Times the renderer's kernels with other features, lane widths and tunings than it would choose,
/// on one frame: scene, camera and lights are set up once, and the G-buffer is drawn once for each
/// layout.
class LightingBench {
 public:
    /// The scene must outlive this. Makes its own headless OpenGL context. Throws Error as Renderer
    /// does.
    LightingBench(const Scene& scene, const RenderSettings& settings, const Camera& camera,
                  double time = 0.0);
    ~LightingBench();
    LightingBench(LightingBench&&) noexcept;
    LightingBench& operator=(LightingBench&&) noexcept;

    /// Builds the stages, runs them and throws them away. The queue is idle before and after.
    LightingRun run(const LightingRequest& request);

    /// What the settings lead to: their plan and tuning.
    LightingRequest request() const;

    /// The device as it describes itself, with its own lane width.
    const DeviceInfo& device() const;
    const Scene& scene() const;
    const RenderSettings& settings() const;

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace kilolux
