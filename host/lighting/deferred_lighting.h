// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/gpu/surface_flow.h"
#include "host/lighting/light_lists.h"
#include "host/lighting/visibility.h"
#include "host/stages/shading/shade.h"

namespace kilolux {

/// The inputs of lighting a frame.
struct LightingInput {
    GBuffer gbuffer;
    LightInput lights;
    ClusterGrid grid{};
    ShadowInput shadows{};                 // with KernelFeatures::shadows
    const ListedLights* others = nullptr;  // the pixels are MorePixels of these lists
};

/// Lights a G-buffer with the lights of each pixel's list: LightLists, Visibility with shadows,
/// Shade.
///
///     DeferredLighting lighting(gpu, tuning, features);
///     const Radiance radiance = lighting.light({gbuffer, lights, grid}, timer);
///
/// What reads the radiance may be enqueued before the one wait of a frame:
///
///     do {
///         const Radiance radiance = lighting.enqueue({gbuffer, lights, grid}, timer);
///         tonemap.enqueue(radiance, exposure, timer);
///     } while (!lighting.fits(timer));
class DeferredLighting {
 public:
    /// `surfaces`: with KernelFeatures::shadows, what of the casters' materials is read.
    DeferredLighting(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                     const SurfaceFeatures& surfaces = {});

    /// Radiance of every pixel; 0 for background. Blocks only for the first shadows and in a
    /// repeat, see Visibility. Valid until the next call. Throws Error as the stages do.
    Radiance enqueue(const LightingInput& input, StageTimer& timer);

    /// False where lists or shadows of the last enqueue() had no room: its results are invalid, and
    /// the next one makes room. Waits for the device. Asked once a frame.
    bool fits(StageTimer& timer);

    /// Repeats both until the lists fit; the timer gets the stages of the last time. Blocks.
    Radiance light(const LightingInput& input, StageTimer& timer);

    /// Radiance that falls in from everywhere.
    void set_ambient(float ambient);

    /// Releases the last results; forget() also what light_lists() keeps, see there.
    void release();
    void forget();

    LightLists& light_lists() { return light_lists_; }
    const LightLists& light_lists() const { return light_lists_; }

    /// Those of the last enqueue().
    const ListedLights& lists() const { return lists_; }

    /// Counts the work of casting the last enqueue()'s shadows: see Visibility::count(). `input`:
    /// that of the last enqueue(). Blocks.
    ShadowCounts count_shadows(const LightingInput& input, CastShadows& counting);

 private:
    LightLists light_lists_;
    std::optional<Visibility> visibility_;  // with shadows
    Shade shade_;
    ListedLights lists_;
    SeenLights seen_;
};

/// Lights a G-buffer with every light at every pixel: DeferredLighting's reference, bit for bit.
class AllLightsLighting {
 public:
    AllLightsLighting(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                      const SurfaceFeatures& surfaces = {});

    /// Radiance of every pixel; 0 for background. Enqueues only. Valid until the next call.
    Radiance enqueue(const LightingInput& input, StageTimer& timer);

    void set_ambient(float ambient) {
        shade_.set_ambient(ambient);
        if (unshadowed_) unshadowed_->set_ambient(ambient);
    }

    /// With sampled shadows, of the last enqueue(): see Shade::variance().
    DeviceArray<float> variance() const { return shade_.variance(); }

    /// Those of the last enqueue(), view space.
    const PreparedLights& lights() const { return lights_; }

 private:
    PrepareLights prepare_;
    std::optional<ShadeAll> unshadowed_;  // with sampled shadows
    ShadeAll shade_;
    PreparedLights lights_;
    bool casts_shadows_;
};

}  // namespace kilolux
