// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include "host/gpu/surface_flow.h"
#include "host/stages/shading/shading_resources.h"

namespace kilolux {

StageWork shade_work(const StageCounts& counts);
inline constexpr StageInfo kShadeStage = {"shade", StageGroup::shading, shade_work};

/// With KernelFeatures::shadows, which lights are seen; or where candidates are marked.
struct SeenInput {
    ShadowWords words{};      // CastShadows' result for the lists
    ShadowSamples samples{};  // of sampled shadows
    ShadowInput tints{};      // with tinted_shadows: the casters, and where rays end
};

/// Radiance of every pixel from the lists of its active cluster, or its codes of a display.
class Shade {
 public:
    /// `surfaces`: with tinted_shadows, what of the casters' materials is read. `candidates`:
    /// without shadows, enqueue() marks in words of 0 which lobes of lights with a size the pixels
    /// may pick by the samples' rays and seed.
    Shade(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
          const SurfaceFeatures& surfaces = {}, bool candidates = false);

    /// Builds the kernel that stores codes by TONE_CURVE_*, or, without one, the kernel that stores
    /// radiance. Otherwise the first enqueue() that needs it builds it. Throws Error.
    void build(std::optional<int> tone_curve);

    /// Enqueues only. `display`: where the codes go, with the bits that Tonemap makes of the
    /// radiance; then there is no radiance.
    Radiance enqueue(const LitPixels& lit, StageTimer& timer, const SeenInput& seen = {},
                     const std::optional<DisplayTarget>& display = {});

    /// With sampled shadows, of the last enqueue(): the estimated variance of each pixel's
    /// luminance, [height][stride]; undefined for background.
    DeviceArray<float> variance() const { return variance_.get(); }

    /// Radiance that falls in from everywhere.
    void set_ambient(float ambient) { ambient_ = ambient; }

 private:
    Tuning tuning_;
    KernelFeatures features_;
    SurfaceFeatures surfaces_;
    bool candidates_;
    ShadingResources resources_;
    std::map<std::optional<int>, Kernel> kernels_;  // by tone curve; none: for radiance
    GrowingArray<float> variance_;
    float ambient_ = 0.0f;
};

/// Radiance of every pixel from every light: the reference for Shade, bit for bit.
class ShadeAll {
 public:
    ShadeAll(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
             const SurfaceFeatures& surfaces = {});

    /// Enqueues only. `shadows`: with KernelFeatures::shadows, the casters; each work-item casts
    /// the rays of its pixels.
    Radiance enqueue(const GBuffer& gbuffer, const PreparedLights& lights, StageTimer& timer,
                     const ShadowInput& shadows = {}, const ShadowSamples& samples = {});

    /// See Shade::variance().
    DeviceArray<float> variance() const { return variance_.get(); }

    /// Radiance that falls in from everywhere.
    void set_ambient(float ambient) { ambient_ = ambient; }

 private:
    ShadingResources resources_;
    Kernel kernel_;
    bool samples_shadows_;
    GrowingArray<float> variance_;
    float ambient_ = 0.0f;
};

}  // namespace kilolux
