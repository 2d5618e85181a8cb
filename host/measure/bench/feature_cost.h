// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench/lighting_bench.h"

namespace kilolux {

/// What a feature that the scene plan left out would cost on the bench's frame.
struct FeatureCost {
    std::string feature;
    bool measured = false;    // false: there is no time, for the reason in `why`
    bool measurable = false;  // whether `ms` is above the noise
    double ms = 0.0;          // additional time of a frame with it
    double noise_ms = 0.0;    // half the width of the 95 % interval of `ms`
    double percent = 0.0;     // of the frame's kernels (and geometry, where the G-buffer grows)
    int bytes_per_pixel = 0;  // additional G-buffer
    std::string why;
};

/// The cost by paired measurements with and without the feature [ms], one difference a turn: their
/// median, and whether it is above its noise, the median's notch().
struct CostEstimate {
    double ms = 0.0;
    double noise_ms = 0.0;
    bool measurable() const { return ms > noise_ms; }
};
CostEstimate estimate_cost(std::vector<double> differences_ms);

/// What is known without measuring of each feature that the plan leaves out, then of the costlier
/// shading models: the bytes, and why there is no time.
std::vector<FeatureCost> left_out_features(const ScenePlan& plan);

/// Compiles each of them in that can be, and times the same frame with and without, in turns, until
/// the difference exceeds its noise or 15 turns have passed. `runs` frames a turn.
std::vector<FeatureCost> measure_feature_costs(LightingBench& bench, int runs = 2);

}  // namespace kilolux
