// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/gpu/stage_timer.h"
#include "host/gpu/tuning_store.h"
#include "host/interop/gbuffer_bridge.h"
#include "host/picture/frame.h"
#include "host/render/light_source.h"
#include "host/render/scene_plan.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "raster/geometry_pass.h"
#include "raster/gl_context.h"
#include "raster/gpu_scene.h"

namespace kilolux {

/// One measurement of the stages from lights to display on a fixed G-buffer.
struct LightingRun {
    // Of the stages the least time over the runs; counts as in a rendered frame.
    FrameStats stats;
    double ms = 0.0;            // sum of the stages' times
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

    /// Builds the stages, runs them and throws them away. The queue is idle before and after.
    LightingRun run(const LightingRequest& request);

    /// What the settings lead to: their plan and tuning.
    LightingRequest request() const;

    /// The device as it describes itself, with its own lane width.
    const DeviceInfo& device() const { return device_; }
    const Scene& scene() const { return scene_; }
    const RenderSettings& settings() const { return settings_; }

 private:
    struct Stages;

    void set_layout(const GBufferNeeds& needs);
    void draw(std::vector<StageTime>* least);
    Radiance light(Stages& stages);

    const Scene& scene_;
    RenderSettings settings_;
    Camera camera_;
    Box box_;
    Gpu gpu_;
    DeviceInfo device_;
    GlContext context_;
    GpuScene gpu_scene_;
    std::optional<GeometryPass> geometry_;
    GBufferBridge bridge_;
    GBuffer gbuffer_;
    LightSource light_source_;
    LightInput lights_;
    FrameStats light_stats_;  // counts of the lights
    StageTimer timer_;
};

}  // namespace kilolux
