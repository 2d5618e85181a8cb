// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/render/lighting_bench.h"

namespace kilolux {

/// What a feature that the scene plan left out would have cost on the bench's frame.
struct FeatureCost {
    std::string feature;
    bool measured = false;    // false: it costs nothing where it is absent, as `why` says
    double ms = 0.0;          // more time a frame with it; negative only by noise
    double noise_ms = 0.0;    // how far the turns without it differ: what `ms` is uncertain by
    double percent = 0.0;     // of the frame's kernels (and its geometry, where the G-buffer grows)
    int bytes_per_pixel = 0;  // more G-buffer
    std::string why;
};

/// Compiles each left-out feature in, and each costlier shading model, and times the same frame
/// with and without, in turns. The picture stays the same but for shading models.
std::vector<FeatureCost> measure_feature_costs(LightingBench& bench, int runs = 5);

}  // namespace kilolux
