// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/surface_flow.h"
#include "host/stages/shading/shading_resources.h"

namespace kilolux {

StageWork draw_shadows_work(const StageCounts& counts);
inline constexpr StageInfo kDrawShadowsStage = {"draw_shadows", StageGroup::shadows,
                                                draw_shadows_work};

/// Draws the lights to which pixels cast shadow rays, as bits in words that CastShadows reserved.
class DrawShadows {
 public:
    DrawShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Sets the words to 0, before Shade marks candidates there. Enqueues only.
    void clear(const ActiveClusters& clusters, const ShadowWords& words, StageTimer& timer);

    /// Enqueues only.
    void enqueue(const LitPixels& lit, const ShadowWords& words, const ShadowSamples& samples,
                 StageTimer& timer);

 private:
    ShadingResources resources_;
    KernelProgram program_;
    Kernel clear_, draw_;
};

}  // namespace kilolux
