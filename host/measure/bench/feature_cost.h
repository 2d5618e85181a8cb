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
    double noise_ms = 0.0;    // `ms` less the low end of its interval of 96 %
    double percent = 0.0;     // of the frame's kernels (and geometry, where the G-buffer grows)
    int bytes_per_pixel = 0;  // additional G-buffer
    std::string why;
};

/// Pairs of frames with and without a feature. Their number is fixed: stopping once a cost shows
/// would find one by chance.
inline constexpr std::size_t kCostTurns = 9;

/// The cost by kCostTurns differences [ms]: their median, and the second least and second largest,
/// between which the true median lies in 96 % of cases, however they are distributed.
struct CostEstimate {
    double ms = 0.0, low = 0.0, high = 0.0;
    bool measurable() const { return low > 0.0; }
    double noise_ms() const { return ms - low; }
};
CostEstimate estimate_cost(std::vector<double> differences_ms);

/// Facts known without measuring about each feature that the plan leaves out, then about the
/// costlier shading models: the bytes, and why there is no time.
std::vector<FeatureCost> left_out_features(const ScenePlan& plan);

/// Compiles in each of them that can be forced, and times the same frame with and without it in
/// kCostTurns turns of `runs` frames.
std::vector<FeatureCost> measure_feature_costs(LightingBench& bench, int runs = 2);

}  // namespace kilolux
