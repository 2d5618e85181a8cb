// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// Radiance of every pixel from the lists of its active cluster, or from all lights.
class Shade {
 public:
    Shade(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Sums over the lists. Enqueues only.
    Radiance enqueue(const GBuffer& gbuffer, const PreparedLights& lights, const ClusterGrid& grid,
                     const ActiveClusters& clusters, const RefinedLists& lists, StageTimer& timer);

    /// Sums over every light: the reference, bit for bit. Enqueues only.
    Radiance enqueue_all_lights(const GBuffer& gbuffer, const PreparedLights& lights,
                                StageTimer& timer);

    /// Radiance that falls in from everywhere.
    void set_ambient(float ambient) { ambient_ = ambient; }

 private:
    Radiance launch(const cl::Program& program, const GBuffer& gbuffer,
                    const PreparedLights& lights, const ClusterGrid& grid,
                    const ActiveClusters& clusters, const RefinedLists& lists, StageTimer& timer);

    cl::Buffer stored_lights(const cl::Program& program, const PreparedLights& lights,
                             StageTimer& timer);

    Gpu gpu_;
    Tuning tuning_;
    KernelFeatures features_;
    cl::Program program_;
    float ambient_ = 0.0f;
    GrowingBuffer srgb_, radiance_, empty_, stored_;
};

}  // namespace kilolux
