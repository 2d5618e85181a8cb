// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/feature_cost.h"

#include <algorithm>

#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

ScenePlan plan_with(const LightingBench& bench, const std::string& feature) {
    RenderSettings settings = bench.settings();
    settings.force_features.push_back(feature);
    return make_scene_plan(bench.scene(), settings,
                           settings.lights.count + bench.scene().lights.size());
}

// The least of a few turns each: what else the machine does then hits both alike.
FeatureCost measure_cost(LightingBench& bench, const std::string& feature, int runs) {
    constexpr int kTurns = 3;
    LightingRequest without = bench.request();
    without.runs = std::max(1, (runs + kTurns - 1) / kTurns);
    LightingRequest with = without;
    with.plan = plan_with(bench, feature);
    FeatureCost cost;
    cost.feature = feature;
    cost.measured = true;
    cost.bytes_per_pixel = with.plan.gbuffer_bytes_per_pixel - without.plan.gbuffer_bytes_per_pixel;
    // Geometry takes longer than all kernels on a CPU: its noise would drown what does not concern
    // it.
    without.geometry = with.geometry = cost.bytes_per_pixel != 0;
    std::vector<double> ms_without, ms_with;
    for (int turn = 0; turn < kTurns; ++turn) {
        ms_without.push_back(bench.run(without).ms);
        ms_with.push_back(bench.run(with).ms);
    }
    const auto [least, most] = std::minmax_element(ms_without.begin(), ms_without.end());
    cost.ms = *std::min_element(ms_with.begin(), ms_with.end()) - *least;
    cost.noise_ms = *most - *least;
    cost.percent = *least > 0.0 ? 100.0 * cost.ms / *least : 0.0;
    return cost;
}

}  // namespace

std::vector<std::string> absent_features(const ScenePlan& plan) {
    std::vector<std::string> names = plan.left_out;
    if (plan.kernels.shading < SHADING_BLINN_PHONG) names.emplace_back("blinn-phong");
    if (plan.kernels.shading < SHADING_PBR) names.emplace_back("pbr");
    return names;
}

bool is_forceable(const std::string& feature) {
    const std::vector<std::string>& names = forceable_features();
    return std::find(names.begin(), names.end(), feature) != names.end();
}

FeatureCost unmeasured_cost(const ScenePlan& plan, const std::string& feature) {
    FeatureCost cost;
    cost.feature = feature;
    cost.bytes_per_pixel = added_bytes_per_pixel(plan, feature);
    if (is_forceable(feature)) {
        cost.why = "not measured yet: kilolux info --costs does";
    } else if (feature == "point-lights") {
        cost.why = "without lights the list stages run on empty lists";
    } else {
        cost.why = "compiled into the shaders of materials that use it only";
    }
    return cost;
}

std::vector<FeatureCost> measure_feature_costs(LightingBench& bench, int runs) {
    std::vector<FeatureCost> costs;
    for (const std::string& feature : absent_features(bench.request().plan)) {
        if (is_forceable(feature)) {
            costs.push_back(measure_cost(bench, feature, runs));
        } else {
            costs.push_back(unmeasured_cost(bench.request().plan, feature));
        }
    }
    return costs;
}

}  // namespace kilolux
