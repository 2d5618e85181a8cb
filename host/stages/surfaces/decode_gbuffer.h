// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "kernels/shared/surface_planes.h"

namespace kilolux {

inline constexpr StageInfo kDecodeGbufferStage = {"decode_gbuffer", StageGroup::surfaces};

/// Decodes the G-buffer as shading does to float planes: for AOVs, views and references.
class DecodeGBuffer {
 public:
    /// Bytes of a pixel at most.
    static constexpr std::size_t kPixelBytes = SURFACE_PLANES_WITH_SPECULAR * sizeof(float);

    DecodeGBuffer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Returns float[plane_count()][height][stride], see kernels/shared/surface_planes.h. Enqueues
    /// only.
    DeviceArray<float> enqueue(const GBuffer& gbuffer, StageTimer& timer);

    /// SURFACE_PLANES, or SURFACE_PLANES_WITH_SPECULAR where the features have it.
    uint plane_count() const { return plane_count_; }

 private:
    Tuning tuning_;
    uint plane_count_;
    Kernel kernel_;
    GrowingArray<float> planes_;
};

}  // namespace kilolux
