// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kCountLightsStage = {"count_lights", StageGroup::lists};

/// Lights per pixel: planes uint[height][stride], ~0 for background.
struct LightCounts {
    DeviceArray<uint> evaluated;  // k: length of the pixel's list
    DeviceArray<uint> covering;   // k*: lights of it whose range covers the pixel
};

/// Counts the lights that shading evaluates and those that reach. For statistics and views.
class CountLights {
 public:
    static constexpr std::size_t kPixelBytes = 2 * sizeof(uint);

    CountLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Enqueues only.
    LightCounts enqueue(const LitPixels& lit, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<uint> evaluated_, covering_;
};

}  // namespace kilolux
