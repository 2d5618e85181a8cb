// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "kernels/shared/gbuffer.h"

namespace kilolux {

inline constexpr StageInfo kDecodeGbufferStage = {"decode_gbuffer", StageGroup::surfaces};

/// Decodes the G-buffer as shading does to float planes: for AOVs, views and references.
class DecodeGBuffer {
 public:
    /// Bytes of a pixel.
    static constexpr std::size_t kPixelBytes = SURFACE_PLANES * sizeof(float);

    DecodeGBuffer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Returns float[SURFACE_PLANES][height][stride], see kernels/shared/gbuffer.h. Enqueues
    /// only.
    DeviceArray<float> enqueue(const GBuffer& gbuffer, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<float> planes_;
};

}  // namespace kilolux
