// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/deferred_lighting.h"

#include "host/gpu/repeat_until_fits.h"
#include "host/lighting/check_input.h"

namespace kilolux {

DeferredLighting::DeferredLighting(const Gpu& gpu, const Tuning& tuning,
                                   const KernelFeatures& features, const SurfaceFeatures& surfaces)
    : light_lists_(gpu, tuning, features), shade_(gpu, tuning, features, surfaces) {
    if (features.shadows) visibility_.emplace(gpu, tuning, features, surfaces);
}

void DeferredLighting::set_ambient(float ambient) {
    shade_.set_ambient(ambient);
    if (visibility_) visibility_->set_ambient(ambient);
}

Radiance DeferredLighting::enqueue(const LightingInput& input, StageTimer& timer) {
    if (visibility_) check_input(input.shadows, input.gbuffer.view);
    release();  // arrays that grow must not be held twice
    // The others' lights are there already, and so the last ones are not.
    if (visibility_ && !input.others &&
        !light_lists_.has_made(input.lights, input.gbuffer, input.grid)) {
        visibility_->save_last(light_lists_, input.lights, input.gbuffer, timer);
    }
    lists_ = input.others ? light_lists_.enqueue_sharing(*input.others, input.gbuffer, timer)
                          : light_lists_.enqueue(input.lights, input.gbuffer, input.grid, timer);
    if (visibility_) seen_ = visibility_->enqueue(lists_, input.gbuffer, input.shadows, timer);
    return shade_.enqueue(lists_.at(input.gbuffer), timer,
                          {seen_.words, seen_.samples, input.shadows});
}

void DeferredLighting::release() {
    lists_ = {};
    seen_ = {};
}

void DeferredLighting::forget() {
    release();
    light_lists_.forget();
    if (visibility_) visibility_->forget();
}

bool DeferredLighting::fits(StageTimer& timer) {
    return light_lists_.fits(timer) && (!visibility_ || visibility_->fits(light_lists_));
}

Radiance DeferredLighting::light(const LightingInput& input, StageTimer& timer) {
    return repeat_until_fits(
        timer, [&] { return enqueue(input, timer); }, [&] { return fits(timer); });
}

ShadowCounts DeferredLighting::count_shadows(const LightingInput& input, CastShadows& counting) {
    return visibility_->count(lists_, input.gbuffer, input.shadows, seen_, counting);
}

AllLightsLighting::AllLightsLighting(const Gpu& gpu, const Tuning& tuning,
                                     const KernelFeatures& features,
                                     const SurfaceFeatures& surfaces)
    : prepare_(gpu, tuning),
      shade_(gpu, tuning, features, surfaces),
      casts_shadows_(features.shadows) {
    if (!features.sampled_shadows) return;
    unshadowed_.emplace(gpu, with_device_lanes(tuning), without_shadows(features));
}

Radiance AllLightsLighting::enqueue(const LightingInput& input, StageTimer& timer) {
    check_input(input.gbuffer);
    check_input(input.lights);
    check_input(input.grid, input.gbuffer.view);
    if (casts_shadows_) check_input(input.shadows, input.gbuffer.view);
    lights_ = prepare_.enqueue(input.lights, input.gbuffer.view, input.grid, timer);
    ShadowSamples samples;
    if (unshadowed_) {
        samples = {unshadowed_->enqueue(input.gbuffer, lights_, timer).planes, input.shadows.rays,
                   input.shadows.seed};
    }
    return shade_.enqueue(input.gbuffer, lights_, timer, input.shadows, samples);
}

}  // namespace kilolux
