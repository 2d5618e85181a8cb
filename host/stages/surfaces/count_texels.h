// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

inline constexpr StageInfo kCountTexelsStage = {"count_texels", StageGroup::surfaces};

/// Counts the texels that each pixel's surface reads. For limits.
class CountTexels {
 public:
    CountTexels(const Gpu& gpu, const Tuning& tuning, const SurfaceFeatures& surfaces);

    /// [view.height][view.stride], 0 for background; ids as ResolveSurfaces reads them. Valid until
    /// the next call. Enqueues only.
    DeviceArray<uint> enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                              const View& view, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<uint> counts_;
};

}  // namespace kilolux
