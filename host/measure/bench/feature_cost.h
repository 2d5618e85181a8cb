// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench/lighting_bench.h"

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

/// The features that a plan leaves out, then the costlier shading models.
std::vector<std::string> absent_features(const ScenePlan& plan);

/// Whether a feature can be compiled in where the scene lacks it, and so measured.
bool is_forceable(const std::string& feature);

/// What is known of a left-out feature's cost without measuring: the bytes, and why there is no
/// time.
FeatureCost unmeasured_cost(const ScenePlan& plan, const std::string& feature);

/// Compiles each left-out feature in, and each costlier shading model, and times the same frame
/// with and without, in turns. The picture stays the same but for shading models.
std::vector<FeatureCost> measure_feature_costs(LightingBench& bench, int runs = 5);

}  // namespace kilolux
