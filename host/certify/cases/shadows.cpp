// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/certify/shadow_scenarios.h"
#include "host/render/renderer.h"

namespace kilolux {
namespace {

// Exactly representable, so that only the sums with it round.
const glm::dvec3 kFar(0x1p20, -0x1p20, 0x1p20);

void try_scenario(const Gpu& gpu, Findings& findings, const ShadowScenario& scenario) {
    const ShadowAgreement found = compare_shadows(scenario, scene_settings(gpu, 160, 90));
    findings.at_least("pixels that face the light", static_cast<std::uint64_t>(found.pixels), 1000);
    findings.none(fmt::format("{}: wrong with no edge near", scenario.name),
                  static_cast<std::uint64_t>(found.unfounded),
                  static_cast<std::uint64_t>(found.pixels));
    findings.at_most(fmt::format("{}: share that differs at edges", scenario.name),
                     static_cast<double>(found.differ) / found.pixels, 0.005);
}

void try_all_lights(const Gpu& gpu, Findings& findings, const ShadowScenario& scenario, int width,
                    std::uint64_t lights) {
    RenderSettings settings = scene_settings(gpu, width, width * 9 / 16);
    settings.shadows = Shadows::exact;
    settings.lights.count = lights;
    const Frame listed = Renderer(scenario.scene, settings).render(scenario.camera, 0.0);
    settings.renderer = RendererKind::deferred_all;
    const Frame all = Renderer(scenario.scene, settings).render(scenario.camera, 0.0);
    findings.require(scenario.name + ": the bits of all lights", listed.radiance == all.radiance);
}

}  // namespace

void try_shadow_edges(const Gpu& gpu, Findings& findings) {
    for (const ShadowScenario& scenario :
         {columns_scenario(), thin_wall_scenario(), grazing_scenario(), spheres_scenario(),
          sheet_scenario()}) {
        try_scenario(gpu, findings, scenario);
        try_scenario(gpu, findings, moved(scenario, kFar));
    }
    try_all_lights(gpu, findings, columns_scenario(), 96, 40);
    try_all_lights(gpu, findings, needles_scenario(), 480, 0);
}

}  // namespace kilolux
