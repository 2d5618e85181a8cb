// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/deferred_lighting.h"

namespace kilolux {

DeferredLighting::DeferredLighting(const Gpu& gpu, const Tuning& tuning,
                                   const KernelFeatures& features, const SurfaceFeatures& surfaces)
    : light_lists_(gpu, tuning, features), shade_(gpu, tuning, features) {
    if (features.shadows) cast_.emplace(gpu, tuning, features, surfaces);
}

Radiance DeferredLighting::light(const LightingInput& input, StageTimer& timer,
                                 const AfterShading& then) {
    Radiance radiance;
    lists_ = {};  // arrays that grow must not be held twice
    lists_ = light_lists_.run(
        input.lights, input.gbuffer, input.grid, timer, [&](const ListedLights& lists) {
            if (cast_) {
                shadows_ = cast_->enqueue(input.shadows, lists.lights, lists.clusters,
                                          lists.refined, input.gbuffer.view, timer);
            }
            radiance = shade_.enqueue(input.gbuffer, lists.lights, input.grid, lists.clusters,
                                      lists.refined, timer, shadows_);
            if (then) then(radiance);
        });
    return radiance;
}

AllLightsLighting::AllLightsLighting(const Gpu& gpu, const Tuning& tuning,
                                     const KernelFeatures& features,
                                     const SurfaceFeatures& surfaces)
    : prepare_(gpu, tuning), shade_(gpu, tuning, features, surfaces) {}

Radiance AllLightsLighting::light(const LightingInput& input, StageTimer& timer,
                                  const AfterShading& then) {
    lights_ = prepare_.enqueue(input.lights, input.gbuffer.view, input.grid, timer);
    const Radiance radiance = shade_.enqueue(input.gbuffer, lights_, timer, input.shadows);
    if (then) then(radiance);
    return radiance;
}

}  // namespace kilolux
