// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/deferred_lighting.h"

#include "host/lighting/check_input.h"

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

void DeferredLighting::set_ambient(float ambient) {
    ambient_ = ambient;
    shade_.set_ambient(ambient);
    if (unshadowed_) unshadowed_->set_ambient(ambient);
}

Radiance DeferredLighting::light(const LightingInput& input, StageTimer& timer,
                                 const AfterShading& then) {
    Radiance radiance;
    lists_ = {};  // arrays that grow must not be held twice
    const Visibility visibility = visibility_of(input);
    if (!keeps(visibility)) {
        kept_.reset();
        shadows_ = {};
        samples_ = {};
    }
    lists_ = light_lists_.run(
        input.lights, input.gbuffer, input.grid, timer, [&](const ListedLights& lists) {
            if (cast_ && !kept_) cast(input, lists, timer);
            radiance =
                shade_.enqueue(lists.at(input.gbuffer), timer, shadows_, samples_, input.display);
            if (then) then(radiance);
        });
    kept_ = visibility;  // the lists that it was cast by are complete
    return radiance;
}

DeferredLighting::Visibility DeferredLighting::visibility_of(const LightingInput& input) const {
    const ShadowInput& shadows = input.shadows;
    return {{input.gbuffer.version, input.lights.version, input.lights.seed, input.grid},
            shadows.rays,
            ambient_,
            shadows.seed};
}

bool DeferredLighting::keeps(const Visibility& wanted) const {
    if (!kept_ || !wanted.lists.matches(kept_->lists)) return false;
    return !draw_ || (wanted.rays == kept_->rays && wanted.seed == kept_->seed &&
                      wanted.ambient == kept_->ambient);
}

void DeferredLighting::cast(const LightingInput& input, const ListedLights& lists,
                            StageTimer& timer) {
    const LitPixels lit = lists.at(input.gbuffer);
    shadows_ = cast_->reserve(lists.lights, lists.clusters, timer);
    if (draw_) {
        samples_.whole = unshadowed_->enqueue(lit, timer).planes;
        samples_.rays = input.shadows.rays;
        samples_.seed = input.shadows.seed;
        draw_->enqueue(lit, shadows_, samples_, timer);
    }
    cast_->enqueue(input.shadows, lit, shadows_, timer);
}

ShadowCounts DeferredLighting::count_shadows(const LightingInput& input, CastShadows& counting) {
    StageTimer untimed;
    const LitPixels lit = lists_.at(input.gbuffer);
    if (draw_) draw_->enqueue(lit, shadows_, samples_, untimed);
    counting.enqueue(input.shadows, lit, shadows_, untimed);
    ShadowCounts out = counting.counts();
    out.words = cast_->words();
    return out;
}

AllLightsLighting::AllLightsLighting(const Gpu& gpu, const Tuning& tuning,
                                     const KernelFeatures& features,
                                     const SurfaceFeatures& surfaces)
    : prepare_(gpu, tuning), shade_(gpu, tuning, features, surfaces) {
    if (features.sampled_shadows) unshadowed_.emplace(gpu, tuning, without_shadows(features));
}

Radiance AllLightsLighting::light(const LightingInput& input, StageTimer& timer,
                                  const AfterShading& then) {
    check_input(input.gbuffer, input.lights);
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
