// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/measure/bench/table.h"
#include "host/measure/metrics/statistics.h"
#include "host/measure/roofline/device_limits.h"
#include "host/render/settings.h"

namespace kilolux {

/// The shading kernel alone, one shading model compiled with one lane width.
struct ShadingMeasurement {
    std::string model;  // "lambert", "blinn-phong", "pbr"
    int lanes = 1;
    Statistics ms;
    double limit_ms = 0.0;  // by the device's limits
    // By its instructions alone, at half of the multiply-add FLOP/s, as rooflines are drawn.
    // Devices with separate adders may take less, which limit_ms includes.
    double instruction_ms = 0.0;
    std::string bound;
    double evaluations = 0.0;
    double bytes = 0.0;
    double speed_up = 0.0;  // least time with one lane / least time with these lanes
};

/// Lights per pixel of measure_shading().
inline constexpr int kShadingLights = 64;

/// Times the all-lights shading kernel on a synthetic full-screen G-buffer (packed, settings' size)
/// with every pixel in range of kShadingLights point lights: each model with 1, 2, 4, 8, 16 and the
/// device's own lanes, in turns, so that other load affects all alike. The arithmetic limits are
/// measured again between the runs; the best counts. Limits are compared with the least times, as
/// both are the best of several runs. `on_run` is called after every run and may
/// throw to stop.
std::vector<ShadingMeasurement> measure_shading(const RenderSettings& settings, DeviceLimits limits,
                                                int runs, const std::function<void()>& on_run);

/// Runs that measure_shading() makes for one of `runs`.
int shading_variants(const RenderSettings& settings);

Table shading_table(const std::vector<ShadingMeasurement>& measurements);

}  // namespace kilolux
