// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

inline constexpr StageInfo kCountSeenStage = {"count_seen", StageGroup::shadows};

/// Lights per pixel: planes uint[height][stride], undefined for background.
struct SeenCounts {
    DeviceArray<uint> facing;  // lights that the pixel faces within their range
    DeviceArray<uint> seen;    // those of them that nothing hides
};

/// Counts the lights that shadows hide. For views.
class CountSeen {
 public:
    CountSeen(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Enqueues only.
    SeenCounts enqueue(const LitPixels& lit, const ShadowWords& shadows, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<uint> facing_, seen_;
};

}  // namespace kilolux
