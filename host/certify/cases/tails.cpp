// SPDX-License-Identifier: Apache-2.0
#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/certify/tail_scenarios.h"
#include "host/scene/generated/scenes.h"

namespace kilolux {
namespace {

// Small clusters, as those of a whole picture are.
RenderSettings tail_settings(const Gpu& gpu, Tails tails, double budget) {
    RenderSettings settings = scene_settings(gpu, 160, 90);
    settings.tails = tails;
    settings.range_budget = budget;
    settings.gbuffer = GBUFFER_FULL;
    return settings;
}

void try_exact(const Gpu& gpu, Findings& findings, const TailScenario& scenario) {
    const RenderSettings settings = tail_settings(gpu, Tails::exact, kDefaultRangeBudget);
    const TailAgreement found = compare_tails(scenario, settings);
    findings.at_least("lit values", static_cast<std::uint64_t>(found.values), 3000);
    findings.at_most(scenario.name + ": exact, |d|/E", found.largest_error, 1e-5);
}

void try_bounds(const Gpu& gpu, Findings& findings, const TailScenario& scenario) {
    for (const Shading shading : {Shading::lambert, Shading::blinn_phong, Shading::pbr}) {
        for (const double budget : {1e-30, 0.01, 1e30}) {
            RenderSettings settings = tail_settings(gpu, Tails::bounded, budget);
            settings.shading = shading;
            const TailAgreement found = compare_tails(scenario, settings);
            findings.none(scenario.name + ": lacks more than its bound",
                          static_cast<std::uint64_t>(found.below),
                          static_cast<std::uint64_t>(found.values));
        }
    }
}

// Checks lights that a tree groups.
void try_trees(const Gpu& gpu, Findings& findings, const TailScenario& scenario) {
    for (const float share : {0.0f, 1.0f}) {
        RenderSettings settings = tail_settings(gpu, Tails::tree, kDefaultRangeBudget);
        settings.tree_share = share;
        const TailAgreement found = compare_tails(scenario, settings);
        findings.none(scenario.name + ": groups err by more than their bound",
                      static_cast<std::uint64_t>(found.below),
                      static_cast<std::uint64_t>(found.values));
        if (share > 0.0f) continue;
        findings.at_most(scenario.name + ": groups of one, |d|/E", found.largest_error, 1e-5);
    }
}

// Directional lights have no range: bounded tails must not change them.
void try_suns(const Gpu& gpu, Findings& findings) {
    Scene scene = make_generated_scene("plain");
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = {0.6, -0.8, 0.0};
    scene.lights = {sun};
    const Camera camera = frame_box(bounds(scene));
    const auto picture = [&](Tails tails) {
        return Renderer(scene, tail_settings(gpu, tails, 0.01)).render(camera, 0.0).radiance;
    };
    const std::vector<float> exact = picture(Tails::exact);
    findings.require("suns alone: the same bits whatever the tails",
                     picture(Tails::bounded) == exact && picture(Tails::stochastic) == exact &&
                         picture(Tails::tree) == exact);
}

}  // namespace

void try_tails(const Gpu& gpu, Findings& findings) {
    for (const TailScenario& scenario : tail_scenarios()) {
        try_exact(gpu, findings, scenario);
        try_bounds(gpu, findings, scenario);
        try_trees(gpu, findings, scenario);
    }
    try_suns(gpu, findings);
}

}  // namespace kilolux
