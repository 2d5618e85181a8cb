// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/picture/bands.h"
#include "host/picture/frame.h"
#include "host/render/light_rows.h"
#include "host/render/scene_plan.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "raster/gpu_scene.h"

namespace kilolux {

/// What every path of a renderer is made for; outlives them.
struct RenderContext {
    const RenderSettings& settings;
    const ScenePlan& plan;
    const Gpu& gpu;
    const Tuning& tuning;
    const GpuScene& gpu_scene;
    const Box& box;  // of the scene at the frame's time, world space [m]
};

/// One sample of a band of a frame to light: the lights on the host and, uploaded, on the device.
struct SampleInput {
    const Camera& camera;  // of the whole picture
    const LightRows& rows;
    LightInput lights;
    Band band;
    bool redraw = true;  // else OpenGL's targets still hold this sample of the band's raster tile
};

}  // namespace kilolux
