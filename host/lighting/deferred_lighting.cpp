// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/deferred_lighting.h"

namespace kilolux {
namespace {

KernelFeatures without_shadows(KernelFeatures features) {
    features.shadows = features.sampled_shadows = false;
    return features;
}

}  // namespace

DeferredLighting::DeferredLighting(const Gpu& gpu, const Tuning& tuning,
                                   const KernelFeatures& features, const SurfaceFeatures& surfaces)
    : light_lists_(gpu, tuning, features), shade_(gpu, tuning, features) {
    if (features.shadows) cast_.emplace(gpu, tuning, features, surfaces);
    if (!features.sampled_shadows) return;
    draw_.emplace(gpu, tuning, features);
    unshadowed_.emplace(gpu, tuning, without_shadows(features));
}

Radiance DeferredLighting::light(const LightingInput& input, StageTimer& timer,
                                 const AfterShading& then) {
    Radiance radiance;
    lists_ = {};  // arrays that grow must not be held twice
    lists_ = light_lists_.run(input.lights, input.gbuffer, input.grid, timer,
                              [&](const ListedLights& lists) {
                                  radiance = shade(input, lists, timer);
                                  if (then) then(radiance);
                              });
    return radiance;
}

Radiance DeferredLighting::shade(const LightingInput& input, const ListedLights& lists,
                                 StageTimer& timer) {
    ShadowSamples samples;
    if (cast_) shadows_ = cast_->reserve(lists.lights, lists.clusters, timer);
    if (draw_) {
        samples.whole = unshadowed_
                            ->enqueue(input.gbuffer, lists.lights, input.grid, lists.clusters,
                                      lists.refined, timer)
                            .planes;
        samples.rays = input.shadows.rays;
        samples.seed = input.shadows.seed;
        draw_->enqueue(input.gbuffer, lists.lights, input.grid, lists.clusters, lists.refined,
                       shadows_, samples, timer);
    }
    if (cast_) {
        cast_->enqueue(input.shadows, lists.lights, lists.clusters, lists.refined,
                       input.gbuffer.view, shadows_, timer);
    }
    return shade_.enqueue(input.gbuffer, lists.lights, input.grid, lists.clusters, lists.refined,
                          timer, shadows_, samples);
}

AllLightsLighting::AllLightsLighting(const Gpu& gpu, const Tuning& tuning,
                                     const KernelFeatures& features,
                                     const SurfaceFeatures& surfaces)
    : prepare_(gpu, tuning), shade_(gpu, tuning, features, surfaces) {
    if (features.sampled_shadows) unshadowed_.emplace(gpu, tuning, without_shadows(features));
}

Radiance AllLightsLighting::light(const LightingInput& input, StageTimer& timer,
                                  const AfterShading& then) {
    lights_ = prepare_.enqueue(input.lights, input.gbuffer.view, input.grid, timer);
    ShadowSamples samples;
    if (unshadowed_) {
        samples.whole = unshadowed_->enqueue(input.gbuffer, lights_, timer).planes;
        samples.rays = input.shadows.rays;
        samples.seed = input.shadows.seed;
    }
    const Radiance radiance = shade_.enqueue(input.gbuffer, lights_, timer, input.shadows, samples);
    if (then) then(radiance);
    return radiance;
}

}  // namespace kilolux
