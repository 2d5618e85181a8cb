// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "host/measure/metrics/metrics.h"
#include "host/measure/metrics/parallel_rows.h"
#include "host/render/renderer.h"

namespace kilolux {

/// The first setting of a picture that its reference does not model, by its option; empty: none. A
/// reference has one sample a pixel, and the light of lights on surfaces alone.
std::string_view beyond_reference(const RenderSettings& settings);

/// Errors of a picture against one reference.
struct ReferenceError {
    HdrMetrics hdr;
    double flip_mean = 0.0;  // HDR-FLIP, 0 to 1
    double flip_max = 0.0;
};

/// A picture's errors against float64. Where surfaces blend both references are of cast rays.
struct FrameError {
    int width = 0;   // at which it was measured [pixel]
    int height = 0;  // [pixel]
    // Error of the kernels: the reference shades the same stored surfaces. None for the forward
    // renderers, which do not store surfaces.
    std::optional<ReferenceError> kernels;
    ReferenceError whole;           // the reference shades surfaces stored in float32
    double lights_per_pixel = 0.0;  // k*, by the reference
    std::vector<double> relative;   // of `whole`: see pixel_errors()
};

/// Renders with `settings`, at most 320 pixels wide so that the float64 reference takes seconds,
/// and compares. Leaves the renderer with other settings. An exception of `progress` ends it.
FrameError measure_frame_error(Renderer& renderer, RenderSettings settings, const Camera& camera,
                               double time, const OnProgress& progress = {});

}  // namespace kilolux
