// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/feature_cost.h"

#include <algorithm>

#include "host/measure/metrics/statistics.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

ScenePlan plan_with(const LightingBench& bench, const std::string& feature) {
    RenderSettings settings = bench.settings();
    settings.force_features.push_back(feature);
    return make_scene_plan(bench.scene(), settings,
                           settings.lights.count + bench.scene().lights.size());
}

bool is_forceable(const std::string& feature) {
    return std::ranges::count(forceable_features(), feature) > 0;
}

void measure_cost(LightingBench& bench, int runs, FeatureCost& cost) {
    LightingRequest without = bench.request();
    without.runs = runs;
    LightingRequest with = without;
    with.plan = plan_with(bench, cost.feature);
    // On a CPU, geometry takes longer than all kernels: it is only timed where the G-buffer grows.
    without.geometry = with.geometry = cost.bytes_per_pixel != 0;
    std::vector<double> differences_ms, base_ms;
    while (differences_ms.size() < kCostTurns) {
        base_ms.push_back(bench.run(without).ms);
        differences_ms.push_back(bench.run(with).ms - base_ms.back());
    }
    const CostEstimate estimate = estimate_cost(differences_ms);
    cost.measured = true;
    cost.measurable = estimate.measurable();
    cost.ms = estimate.ms;
    cost.noise_ms = estimate.noise_ms();
    cost.percent = 100.0 * estimate.ms / statistics(base_ms).median;
}

}  // namespace

CostEstimate estimate_cost(std::vector<double> differences_ms) {
    std::ranges::sort(differences_ms);
    return {quantile(differences_ms, 0.5), differences_ms.at(1),
            differences_ms.at(differences_ms.size() - 2)};
}

std::vector<FeatureCost> left_out_features(const ScenePlan& plan) {
    std::vector<std::string> names = plan.left_out;
    const bool can_be_phong = plan.kernels.shading < SHADING_BLINN_PHONG;
    if (can_be_phong && !plan.kernels.area_lights) names.emplace_back("blinn-phong");
    if (plan.kernels.shading < SHADING_PBR) names.emplace_back("pbr");
    std::vector<FeatureCost> costs;
    for (const std::string& name : names) {
        FeatureCost& cost = costs.emplace_back();
        cost.feature = name;
        cost.bytes_per_pixel = added_bytes_per_pixel(plan, name);
        cost.why = is_forceable(name) ? "not measured: kilolux info --costs does"
                   : name == "point-lights"
                       ? "without lights the list stages run on empty lists"
                       : "compiled in where something of the scene uses it only";
    }
    return costs;
}

std::vector<FeatureCost> measure_feature_costs(LightingBench& bench, int runs) {
    std::vector<FeatureCost> costs = left_out_features(bench.request().plan);
    for (FeatureCost& cost : costs) {
        if (!is_forceable(cost.feature)) continue;
        cost.why.clear();
        measure_cost(bench, runs, cost);
    }
    return costs;
}

}  // namespace kilolux
