// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/stage_info.h"
#include "host/measure/roofline/device_limits.h"
#include "host/picture/frame.h"
#include "host/render/scene_plan.h"
#include "host/render/settings.h"

/// A lower bound for each stage's time: the work that it declares, at the device's measured rates.
///
/// Registers and near caches are free; texels come from the nearest cache, one by one. Special
/// functions are also counted apart, as their units are slower. Tunables (chunks, groups, lanes)
/// cost nothing.
namespace kilolux {

/// Which limit of the device bounds a stage.
enum class Bound { bytes, instructions, special_functions, texels, launches };
const char* bound_name(Bound bound);

/// The time that work takes at the limits: the greatest of its bytes', instructions', special
/// functions' and texels' time, and its launches beside.
struct StageLimit {
    double ms = 0.0;
    Bound bound = Bound::launches;
};
StageLimit stage_limit(const StageWork& work, const DeviceLimits& limits);

/// How the frame was made, as far as its FrameStats do not say.
struct FrameSetup {
    int width = 0;
    int height = 0;
    KernelFeatures kernels;
    int gbuffer_bytes_per_pixel = 12;
    int bridge_bytes_per_pixel = 12;
    RendererKind renderer = RendererKind::deferred;
    bool device_is_host = true;
};
FrameSetup frame_setup(const RenderSettings& settings, const ScenePlan& plan,
                       const DeviceInfo& device);

StageCounts stage_counts(const FrameStats& stats, const FrameSetup& setup);

/// Sets limit_ms of every stage; 0 where it declares no work.
void fill_limits(FrameStats& stats, const DeviceLimits& limits, const FrameSetup& setup);

}  // namespace kilolux
