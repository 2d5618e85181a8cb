// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "host/gpu/surface_flow.h"
#include "host/lighting/light_lists.h"
#include "host/stages/shading/shade.h"
#include "host/stages/shadows/cast_shadows.h"

namespace kilolux {

/// What a frame is lit from.
struct LightingInput {
    GBuffer gbuffer;
    LightInput lights;
    ClusterGrid grid{};
    ShadowInput shadows{};  // with KernelFeatures::shadows
    // Where the picture goes in place of radiance, which is not made then.
    std::optional<DisplayTarget> display = {};
};

/// Enqueues what reads a frame's radiance. It may run more than once a frame; only the last run's
/// results count.
using AfterShading = std::function<void(const Radiance&)>;

/// Lights a G-buffer with the lights of each pixel's list: LightLists, then Shade.
///
///     DeferredLighting lighting(gpu, tuning, features);
///     const Radiance radiance = lighting.light({gbuffer, lights, grid}, timer);
class DeferredLighting {
 public:
    /// `surfaces`: with KernelFeatures::shadows, what of the casters' materials is read.
    DeferredLighting(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                     const SurfaceFeatures& surfaces = {});

    /// Builds what light() needs for a DisplayTarget's tone curve; none: for radiance. Else the
    /// first light() does.
    void build(std::optional<int> tone_curve) { shade_.build(tone_curve); }

    /// Radiance of every pixel; 0 for background. `then` runs before the frame is waited for.
    /// Which lights pixels see is kept while the versions of G-buffer and lights stay, and the
    /// grid. Blocks. Valid until the next call. Throws Error as the stages do.
    Radiance light(const LightingInput& input, StageTimer& timer, const AfterShading& then = {});

    /// Radiance that falls in from everywhere.
    void set_ambient(float ambient);

    LightLists& light_lists() { return light_lists_; }
    const LightLists& light_lists() const { return light_lists_; }

    /// Those of the last light().
    const ListedLights& lists() const { return lists_; }

    /// Which pixels saw which lights in the last light(), with KernelFeatures::shadows.
    const ShadowWords& shadows() const { return shadows_; }

    /// With sampled shadows, what the last light() drew by.
    const ShadowSamples& samples() const { return samples_; }

    /// What it took to cast them, by `counting` kernels, which cast them again. `input`: that of
    /// the last light(). Blocks.
    ShadowCounts count_shadows(const LightingInput& input, CastShadows& counting);

    /// With sampled shadows, of the last light(): see Shade::variance().
    DeviceArray<float> variance() const { return shade_.variance(); }

 private:
    // What the visibility of a frame is of.
    struct Visibility {
        ListSource lists;
        float rays = 0.0f, ambient = 0.0f;  // of sampled shadows
        uint seed = 0;
    };
    Visibility visibility_of(const LightingInput& input) const;
    bool keeps(const Visibility& wanted) const;
    void cast(const LightingInput& input, const ListedLights& lists, StageTimer& timer);

    LightLists light_lists_;
    std::optional<CastShadows> cast_;  // with shadows
    std::optional<DrawShadows> draw_;  // with sampled ones
    std::optional<Shade> unshadowed_;  // likewise
    Shade shade_;
    float ambient_ = 0.0f;
    ListedLights lists_;
    std::optional<Visibility> kept_;  // of shadows_ and samples_
    ShadowWords shadows_;
    ShadowSamples samples_;
};

/// Lights a G-buffer with every light at every pixel: DeferredLighting's reference, bit for bit.
class AllLightsLighting {
 public:
    AllLightsLighting(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                      const SurfaceFeatures& surfaces = {});

    /// As DeferredLighting::light(), but always radiance.
    Radiance light(const LightingInput& input, StageTimer& timer, const AfterShading& then = {});

    void set_ambient(float ambient) {
        shade_.set_ambient(ambient);
        if (unshadowed_) unshadowed_->set_ambient(ambient);
    }

    /// As DeferredLighting's.
    DeviceArray<float> variance() const { return shade_.variance(); }

    /// Those of the last light(), view space.
    const PreparedLights& lights() const { return lights_; }

 private:
    PrepareLights prepare_;
    std::optional<ShadeAll> unshadowed_;  // with sampled shadows
    ShadeAll shade_;
    PreparedLights lights_;
};

}  // namespace kilolux
