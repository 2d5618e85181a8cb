// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/deferred_lighting.h"

namespace kilolux {

DeferredLighting::DeferredLighting(const Gpu& gpu, const Tuning& tuning,
                                   const KernelFeatures& features)
    : light_lists_(gpu, tuning, features), shade_(gpu, tuning, features) {}

Radiance DeferredLighting::light(const LightingInput& input, StageTimer& timer,
                                 const AfterShading& then) {
    Radiance radiance;
    lists_ = {};  // arrays that grow must not be held twice
    lists_ = light_lists_.run(input.lights, input.gbuffer, input.grid, timer,
                              [&](const ListedLights& lists) {
                                  radiance = shade_.enqueue(input.gbuffer, lists.lights, input.grid,
                                                            lists.clusters, lists.refined, timer);
                                  if (then) then(radiance);
                              });
    return radiance;
}

AllLightsLighting::AllLightsLighting(const Gpu& gpu, const Tuning& tuning,
                                     const KernelFeatures& features)
    : prepare_(gpu, tuning), shade_(gpu, tuning, features) {}

Radiance AllLightsLighting::light(const LightingInput& input, StageTimer& timer,
                                  const AfterShading& then) {
    lights_ = prepare_.enqueue(input.lights, input.gbuffer.view, input.grid, timer);
    const Radiance radiance = shade_.enqueue(input.gbuffer, lights_, timer);
    if (then) then(radiance);
    return radiance;
}

}  // namespace kilolux
