// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/roofline/roofline.h"

namespace kilolux {

/// A stage's row of a table: how long it took, how long it must take, and what it did.
struct StageReport {
    std::string stage;
    double ms = 0.0;
    double limit_ms = 0.0;  // 0: no model
    double ratio = 0.0;     // limit_ms / ms: 1 is perfect; 0: no model
    double bytes = 0.0;     // that it must move
    double gigabytes_per_s = 0.0;
    double evaluations = 0.0;  // lights at pixels (shade), lights against boxes (refine_lights)
    double giga_evaluations_per_s = 0.0;
    std::string bound;  // what limits it: "bytes", "instructions", "special functions", "launches";
                        // empty: no model
};

/// How well a frame's device stages do, as two numbers that belong together: a kernel at the
/// device's limit that evaluates lights in vain is as slow as a lazy one that does not.
struct Efficiency {
    double hardware = 0.0;  // limits / times of the stages that have both
    double algorithm =
        0.0;  // k* / k: lights that reach the pixel of those evaluated; < 0: k* not counted
    double overall() const { return algorithm < 0.0 ? -1.0 : hardware * algorithm; }
};

/// One row a stage, in the frame's order.
std::vector<StageReport> stage_reports(const FrameStats& stats, const DeviceLimits& limits,
                                       const FrameSetup& setup);

/// Of OpenCL's stages: those of OpenGL and of the host are not held against the device's
/// arithmetic.
Efficiency efficiency_of(const std::vector<StageReport>& reports, const FrameStats& stats);

}  // namespace kilolux
