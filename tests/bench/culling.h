// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/measure/bench/table.h"
#include "host/measure/metrics/statistics.h"
#include "host/measure/roofline/device_limits.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Coarse light lists by the pipeline's stages and by brute force, for one number of lights.
struct CullingMeasurement {
    std::uint64_t lights = 0;
    std::uint64_t clusters = 0;
    std::uint64_t pairs = 0;  // entries of the lists
    Statistics prepare_ms;
    Statistics cull_ms;
    Statistics brute_force_ms;            // every light against every cluster's box
    double limit_ms = 0.0;                // of cull, by the device's limits
    double bytes_limit_ms = 0.0;          // of cull, by bandwidth alone
    double bytes = 0.0;                   // that cull must move
    std::uint64_t brute_force_pairs = 0;  // equal to `pairs`, or there is a bug
    std::uint64_t foreign_pairs = 0;      // entries that brute force lacks: 0, or there is a bug
};

/// Measures the lists of `light_count` generated lights (settings.lights, but for the count) for
/// the camera's view of the scene at `time`: medians of `runs` after a warm-up. Brute force runs as
/// often, but only once where it takes longer than a second. No picture is drawn.
CullingMeasurement measure_culling(const Scene& scene, const RenderSettings& settings,
                                   const Camera& camera, double time, std::uint64_t light_count,
                                   const DeviceLimits& limits, int runs);

Table culling_table(const std::vector<CullingMeasurement>& measurements);

}  // namespace kilolux
