// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/roofline/roofline.h"

namespace kilolux {

/// A stage's work in a frame, and its least time.
struct StageEffort {
    double limit_ms = 0.0;  // by the device's measured limits; 0: none
    std::string bound;      // what limits it, as bound_name() says; empty: nothing
    double bytes = 0.0;     // that it must at least move
    // Of shading: lights evaluated in full at a pixel; of refine_lights: lights against boxes.
    // Of cast_shadows: rays.
    double evaluations = 0.0;
    // Of cast_shadows, where it was counted: walks, and pairs of a pixel and a listed light that
    // need no ray, since the light is behind the surface, out of range or not picked.
    double shafts = 0.0;
    double saved_rays = 0.0;
};

/// A stage's row of a table.
struct StageReport : StageEffort {
    std::string stage;
    double ms = 0.0;
};

/// How well a frame's device stages do, as two factors: how near the kernels are to the device's
/// limits, and how much of their work was needed.
struct Efficiency {
    double hardware = 0.0;   // limits / times of the stages that have both
    double algorithm = 0.0;  // k* / k; < 0: k* not counted
};

/// One row a stage, in the frame's order.
std::vector<StageReport> stage_reports(const FrameStats& stats, const DeviceLimits& limits,
                                       const FrameSetup& setup);

/// Efficiency over the stages that have a limit, without the copy from OpenGL.
Efficiency efficiency_of(const std::vector<StageReport>& reports, const FrameStats& stats);

/// The part of the frame's time that belongs to no stage [ms]: host work, waiting, driver.
double outside_stages_ms(const FrameStats& stats);

/// Rows beside the stages': outside_stages_ms(), and the frame as the host's clock sees it.
inline constexpr StageInfo kOtherStage = {"other", StageGroup::host};
inline constexpr StageInfo kFrameStage = {"frame", StageGroup::host};

}  // namespace kilolux
