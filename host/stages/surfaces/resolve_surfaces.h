// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

StageWork resolve_surfaces_work(const StageCounts& counts);
inline constexpr StageInfo kResolveSurfacesStage = {"resolve_surfaces", StageGroup::surfaces,
                                                    resolve_surfaces_work};

/// Triangle ids -> G-buffer.
class ResolveSurfaces {
 public:
    ResolveSurfaces(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                    const SurfaceFeatures& surfaces);

    /// The planes of `layout` for ids[view.height][view.stride]: 0 for background, else 1 + the
    /// number of a triangle, counted along the instances. Enqueues only.
    GBuffer enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                    const GBufferLayout& layout, const View& view, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<std::byte> planes_;
};

}  // namespace kilolux
