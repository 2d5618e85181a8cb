// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

StageWork shadow_origins_work(const StageCounts& counts);
inline constexpr StageInfo kShadowOriginsStage = {"shadow_origins", StageGroup::shadows,
                                                  shadow_origins_work};

/// Where every pixel's shadow rays end.
class ShadowOrigins {
 public:
    static constexpr std::size_t kPlanes = 4;
    static constexpr std::size_t kPixelBytes = kPlanes * sizeof(float);

    ShadowOrigins(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// The origins for a G-buffer made of `ids`, which number the triangles of `scene`'s instances.
    /// Background is undefined. Enqueues only.
    DeviceArray<float> enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                               const GBuffer& gbuffer, const ShadowCasters& casters,
                               const ShadowView& shadow, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<float> origins_;
};

}  // namespace kilolux
