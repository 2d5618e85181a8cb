// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "host/measure/roofline/device_limits.h"
#include "host/measure/roofline/instruction_counts.h"
#include "host/picture/frame.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/settings.h"

/// A lower bound for each stage's time: the work it cannot avoid, at the device's measured rates.
///
/// Bytes: each input and output once for every launch that needs it; registers and near caches are
/// free. Instructions: see instruction_counts.h; special functions are also counted apart, as their
/// units are slower. Texels come from the nearest cache, one by one. Lights that evaluate() leaves
/// early count as range tests only. Tunables (chunks, groups, lanes) cost nothing. OpenGL's and the
/// host's stages have no model.
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
    double triangles = 0.0;  // that OpenCL draws
    double triangle_pairs = 0.0;
    // Of resolving; not counted: 0.
    double seen_triangles = 0.0;
    double texels = 0.0;
    double evaluations = 0.0;       // of lights at pixels: k * drawn_pixels
    double full_evaluations = 0.0;  // of those that do not leave early; not counted: 0
    // Of shadows, see ShadowCounts; not counted: 0.
    double shadow_rays = 0.0;
    double shadow_seen = 0.0;
    double shadow_nodes = 0.0;
    double shadow_triangles = 0.0;
    double shadow_points = 0.0;
    double shadow_words = 0.0;
    bool all_lights = false;      // are evaluated at every pixel
    bool shaded_display = false;  // shading makes codes of a display in place of radiance
    double gbuffer_bytes_per_pixel = 12.0;
    double bridge_bytes_per_pixel = 12.0;  // that OpenGL hands over: the G-buffer, or ids
    bool device_is_host = true;            // the device reads them where OpenGL left them
    KernelFeatures kernels;
};

/// What a stage must at least do.
struct StageWork {
    double bytes_read = 0.0;
    double bytes_written = 0.0;
    double bytes_uploaded = 0.0;  // from host memory to a device with its own
    InstructionCounts instructions{};
    double texels = 0.0;  // read at places of their own
    int launches = 0;

    double bytes() const { return bytes_read + bytes_written; }  // in the device's memory
};

/// The work of a stage by its name in FrameStats::stages; none for a stage without a model.
std::optional<StageWork> stage_work(std::string_view stage, const StageCounts& counts);

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

/// Sets limit_ms of every stage that has a model.
void fill_limits(FrameStats& stats, const DeviceLimits& limits, const FrameSetup& setup);

}  // namespace kilolux
