// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/gpu/surface_flow.h"
#include "host/lighting/light_lists.h"
#include "host/stages/shading/shade.h"
#include "host/stages/shadows/cast_shadows.h"
#include "host/stages/shadows/draw_shadows.h"
#include "host/stages/shadows/keep_shadows.h"

namespace kilolux {

/// Which pixels see which lights of their lists; with sampled shadows, what the rays were picked
/// by.
struct SeenLights {
    ShadowWords words;
    ShadowSamples samples;
    DeviceArray<uint> kept{};  // see ShadowTargets
};

/// The features of kernels for the unshadowed light that sampled shadows start from.
KernelFeatures without_shadows(KernelFeatures features);

/// Finds out which of the lights in its list each pixel sees: by CastShadows, after DrawShadows
/// with sampled ones.
class Visibility {
 public:
    /// `features` have shadows. `surfaces`: what of the casters' materials is read.
    Visibility(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
               const SurfaceFeatures& surfaces);

    /// Before `lists` make others than their last ones: saves the last frame's exact shadows, so
    /// that enqueue() casts only those of lights that have moved, if the surfaces are the same.
    void save_last(const LightLists& lists, const LightInput& lights, const GBuffer& gbuffer,
                   StageTimer& timer);

    /// Casts the rays, but those of save_last(). Returns the last result while the version of the
    /// lists stays and the rays are picked alike. Blocks for the number of words, unless fits()
    /// was true for the last result. Valid until the next call.
    SeenLights enqueue(const ListedLights& lists, const GBuffer& gbuffer,
                       const ShadowInput& shadows, StageTimer& timer);

    /// False where the last result, for the complete `lists`, had no room: it is not valid, the
    /// next call makes room, and `lists` are made again, so that the next frame has all stages.
    /// Waits for the number of words. Asked once a frame.
    bool fits(LightLists& lists);

    /// Releases the last results.
    void forget();

    /// Counts the work of casting `seen`, the last enqueue()'s result, by casting it again with the
    /// `counting` kernels. Blocks.
    ShadowCounts count(const ListedLights& lists, const GBuffer& gbuffer,
                       const ShadowInput& shadows, const SeenLights& seen, CastShadows& counting);

    /// Radiance that falls in from everywhere, which sampled shadows weigh lights against.
    void set_ambient(float ambient);

 private:
    // Draws rays into `words`; the radiance if all lights are seen.
    DeviceArray<float> draw(const LitPixels& lit, const ShadowWords& words,
                            const ShadowSamples& samples, StageTimer& timer);

    // The inputs of the last enqueue().
    struct Source {
        std::uint64_t lists = 0;
        float rays = 0.0f, ambient = 0.0f;  // of sampled shadows
        uint seed = 0;
        bool operator==(const Source&) const = default;
    };

    uint area_lobes_;  // of lights with a size, whose rays are sampled; 0: there are none
    CastShadows cast_;
    std::optional<DrawShadows> draw_;  // with sampled shadows
    std::optional<Shade> unshadowed_;  // likewise
    float ambient_ = 0.0f;
    std::optional<Source> source_;
    SeenLights seen_;
    std::optional<KeepShadows> keep_;  // with exact shadows
    bool is_saved_next_ = false;       // save_last() was called for the next enqueue()
    std::optional<LitPixels> lit_;     // of the last enqueue() then
};

}  // namespace kilolux
