// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// The G-buffer as shading sees it, as float planes: for AOVs, views and references.
class DecodeGBuffer {
   public:
    DecodeGBuffer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Returns float[SURFACE_PLANES][height][stride], see kernels/shared/surface_planes.h. Enqueues only.
    cl::Buffer enqueue(const GBuffer& gbuffer, StageTimer& timer);

   private:
    Gpu gpu_;
    Tuning tuning_;
    cl::Program program_;
    GrowingBuffer srgb_, planes_;
};

}  // namespace kilolux
