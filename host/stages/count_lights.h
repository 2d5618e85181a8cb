// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// Lights per pixel: planes uint[height][stride], ~0 for background.
struct LightCounts {
    cl::Buffer evaluated;  // k: length of the pixel's list
    cl::Buffer covering;   // k*: lights of it whose range covers the pixel
};

/// Counts what shading evaluates and what it needs. For statistics and views.
class CountLights {
 public:
    CountLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Enqueues only.
    LightCounts enqueue(const GBuffer& gbuffer, const PreparedLights& lights,
                        const ClusterGrid& grid, const ActiveClusters& clusters,
                        const RefinedLists& lists, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    cl::Program program_;
    GrowingBuffer evaluated_, covering_;
};

}  // namespace kilolux
