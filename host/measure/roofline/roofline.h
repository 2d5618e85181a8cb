// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/gpu/features.h"
#include "host/measure/roofline/device_limits.h"
#include "host/picture/frame.h"
#include "host/render/scene_plan.h"
#include "host/render/settings.h"

/// The least that each stage must do, as numbers, and the time that takes at the device's limits.
///
/// How it is counted. Bytes: what the stage's inputs and outputs hold, each once for every launch
/// that needs it; what stays in registers or is read again from a near cache costs nothing. Lane
/// instructions: the operations that the kernels' source spells, per pixel, light or pair, with fma
/// as one; comparisons, selections, conversions and bit operations count one each, negations
/// nothing, what does not change in the loop nothing, loads and stores nothing (they are bytes),
/// loop counters and list bookkeeping nothing, and a special function one. Special functions are
/// counted beside, as the devices' units for them are slower. Tunables (chunks, groups) cost
/// nothing: what they add is loss. So a limit is a lower bound of the algorithm as it is, not of
/// the best conceivable one; how far the algorithm is from that says k* / k.
namespace kilolux {

/// What the stages of one frame had to work on.
struct StageCounts {
    double pixels = 0.0;        // of the image
    double drawn_pixels = 0.0;  // that are not background
    double lights = 0.0;        // point and spot
    double directional_lights = 0.0;
    double tiles = 0.0;          // fine tiles
    double box_intervals = 0.0;  // of the coarse grid: slices * (tiles_x + tiles_y + 1)
    double clusters = 0.0;       // coarse
    double coarse_pairs = 0.0;
    double active_clusters = 0.0;
    double refine_tests = 0.0;  // entries of the active clusters' coarse lists
    double refined_pairs = 0.0;
    double evaluations = 0.0;  // of lights at pixels: k * drawn_pixels
    double gbuffer_bytes_per_pixel = 12.0;
    bool device_is_host = true;  // the device reads the G-buffer where OpenGL left it
    KernelFeatures kernels;
};

/// Operations of one lane, the special ones beside.
struct LaneWork {
    double instructions = 0.0;  // all, with the special ones as one each
    double rsqrts = 0.0;
    double sqrts = 0.0;
    double divisions = 0.0;
    bool operator==(const LaneWork&) const = default;
};

LaneWork operator+(const LaneWork& a, const LaneWork& b);
LaneWork operator*(double times, const LaneWork& work);

/// Of one light at one pixel: evaluate() of kernels/shared/evaluate.h.
LaneWork work_of_evaluation(const KernelFeatures& kernels);

/// Of a directional light at one pixel: evaluate_directional().
LaneWork work_of_directional(const KernelFeatures& kernels);

/// Of one drawn pixel beside its lights: decoding, make_shading_point() and finish_shading().
LaneWork work_of_pixel(const KernelFeatures& kernels);

/// What a stage must at least do.
struct StageWork {
    double bytes_read = 0.0;
    double bytes_written = 0.0;
    double bytes_uploaded = 0.0;  // from host memory to a device with its own
    LaneWork lanes;
    int launches = 0;
};

/// The work of a stage by its name in FrameStats::stages; none for a stage without a model
/// (light_input runs on the host).
std::optional<StageWork> stage_work(std::string_view stage, const StageCounts& counts);

/// What of the device bounds a stage.
enum class Bound { bytes, instructions, special_functions, launches };
const char* bound_name(Bound bound);

/// The time that work takes at the limits: the greatest of its bytes', instructions' and special
/// functions' time, and its launches beside.
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
    RendererKind renderer = RendererKind::deferred;
    bool device_is_host = true;
};
FrameSetup frame_setup(const RenderSettings& settings, const ScenePlan& plan,
                       const DeviceInfo& device);

StageCounts stage_counts(const FrameStats& stats, const FrameSetup& setup);

/// Sets limit_ms of every stage that has a model.
void fill_limits(FrameStats& stats, const DeviceLimits& limits, const FrameSetup& setup);

}  // namespace kilolux
