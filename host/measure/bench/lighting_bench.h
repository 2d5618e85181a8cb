// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "host/gpu/stage_timer.h"
#include "host/gpu/tuning/tuning_store.h"
#include "host/lighting/deferred_lighting.h"
#include "host/picture/frame.h"
#include "host/render/lights/light_source.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/render_scene.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"

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
    bool geometry = false;  // also what makes the G-buffer, anew in each run
    bool counts = false;    // also stats.shadows, by one more pass
    Geometry drawn_by = Geometry::automatic;
};

/// Times the renderer's kernels with other features, lane widths and tunings than it would choose,
/// on one frame: scene, camera and lights are set up once, and the G-buffer is drawn once for each
/// layout and way of drawing.
class LightingBench {
 public:
    /// The scene must outlive this. Makes its own headless OpenGL context where it needs one.
    /// Throws Error as Renderer does.
    LightingBench(const Scene& scene, const RenderSettings& settings, const Camera& camera,
                  double time = 0.0);
    ~LightingBench();

    /// Builds the stages, runs them and destroys them. The queue is idle before and after.
    LightingRun run(const LightingRequest& request);

    /// The plan and the tuning that the settings lead to.
    LightingRequest request() const;

    /// The device as it describes itself, with its own lane width.
    const DeviceInfo& device() const { return device_; }
    const Scene& scene() const { return scene_; }
    const RenderSettings& settings() const { return settings_; }

 private:
    struct Stages;
    struct Drawing;

    void set_drawing(const LightingRequest& request);
    void draw(FrameStats& stats);
    LightingInput input() const;
    Radiance light(Stages& stages);

    const Scene& scene_;
    RenderSettings settings_;
    Camera camera_;
    Box box_;
    Gpu gpu_;
    DeviceInfo device_;
    std::shared_ptr<RenderScene> render_scene_;
    std::unique_ptr<Drawing> drawing_;  // of the last request's kind
    GBuffer gbuffer_;
    LightSource light_source_;
    LightInput lights_;
    FrameStats light_stats_;  // counts of the lights
    StageTimer timer_;
};

}  // namespace kilolux
