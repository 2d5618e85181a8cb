// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/visibility.h"

#include <utility>

#include "kernels/shared/shadow.h"

namespace kilolux {

KernelFeatures without_shadows(KernelFeatures features) {
    features.shadows = features.sampled_shadows = false;
    return features;
}

Visibility::Visibility(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                       const SurfaceFeatures& surfaces)
    : area_lobes_(features.sampled_shadows && features.area_lights ? AREA_LOBES_OF(features.shading)
                                                                   : 0),
      cast_(gpu, tuning, features, surfaces) {
    if (!features.sampled_shadows) {
        keep_.emplace(gpu, tuning, features, kCastShadowsStage);
        return;
    }
    draw_.emplace(gpu, tuning, features);
    unshadowed_.emplace(gpu, with_device_lanes(tuning), without_shadows(features),
                        SurfaceFeatures{}, features.area_lights);
}

void Visibility::set_ambient(float ambient) {
    ambient_ = ambient;
    if (unshadowed_) unshadowed_->set_ambient(ambient);
}

DeviceArray<float> Visibility::draw(const LitPixels& lit, const ShadowWords& words,
                                    const ShadowSamples& samples, StageTimer& timer) {
    draw_->clear(lit.clusters, words, timer);
    ShadowSamples drawn = samples;
    drawn.whole = unshadowed_->enqueue(lit, timer, {.words = words, .samples = samples}).planes;
    draw_->enqueue(lit, words, drawn, timer);
    return drawn.whole;
}

void Visibility::save_last(const LightLists& lists, const LightInput& lights,
                           const GBuffer& gbuffer, StageTimer& timer) {
    if (!keep_) return;
    const bool has_same_surfaces =
        lit_ && gbuffer.version != 0 && lit_->gbuffer.version == gbuffer.version;
    if (has_same_surfaces && lists.are_complete() && !lights.have_all_moved) {
        keep_->save(*lit_, {seen_.words, cast_.words()}, lists.counts(), timer);
    } else {
        keep_->forget();
    }
    lit_.reset();
    is_saved_next_ = true;
}

bool Visibility::fits(LightLists& lists) {
    if (!source_ || cast_.fits()) return true;
    forget();
    lists.forget();
    return false;
}

void Visibility::forget() {
    source_.reset();
    seen_ = {};
    lit_.reset();
    if (keep_) keep_->forget();
}

SeenLights Visibility::enqueue(const ListedLights& lists, const GBuffer& gbuffer,
                               const ShadowInput& shadows, StageTimer& timer) {
    const Source source =
        draw_ ? Source{lists.version, shadows.rays, ambient_, shadows.seed} : Source{lists.version};
    if (source_ == source) return seen_;
    source_.reset();
    seen_ = {};  // arrays that grow must not be held twice
    const LitPixels lit = lists.at(gbuffer);
    const uint slots = slots_of_light(area_lobes_, shadows.rays);
    seen_.words = cast_.reserve(lists.lights, lists.clusters, timer, slots);
    if (draw_) {
        seen_.samples = {{}, shadows.rays, shadows.seed};
        seen_.samples.whole = draw(lit, seen_.words, seen_.samples, timer);
    }
    if (keep_) seen_.kept = keep_->enqueue(lit, seen_.words, timer);
    if (std::exchange(is_saved_next_, false)) {
        lit_ = lit;
        lit_->gbuffer.bytes = {};  // may grow
    }
    cast_.enqueue(shadows, lit, {seen_.words, seen_.kept}, timer, seen_.samples);
    source_ = source;
    return seen_;
}

ShadowCounts Visibility::count(const ListedLights& lists, const GBuffer& gbuffer,
                               const ShadowInput& shadows, const SeenLights& seen,
                               CastShadows& counting) {
    StageTimer untimed;
    const LitPixels lit = lists.at(gbuffer);
    if (draw_) draw(lit, seen.words, seen.samples, untimed);
    counting.enqueue(shadows, lit, {seen.words, seen.kept}, untimed, seen.samples);
    ShadowCounts out = counting.counts();
    out.words = cast_.words();
    return out;
}

}  // namespace kilolux
