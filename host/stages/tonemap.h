// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"

namespace kilolux {

/// Linear radiance to 8-bit sRGB.
class Tonemap {
 public:
    /// `tone_curve`: TONE_CURVE_*.
    Tonemap(const Gpu& gpu, const Tuning& tuning, int tone_curve);

    /// Returns uint[height][stride]: R | G << 8 | B << 16 | 255 << 24. Enqueues only.
    DeviceArray<uint> enqueue(const Radiance& radiance, float exposure_ev, StageTimer& timer);

    /// The same into the caller's `display`, which has room for all pixels. Enqueues only.
    void enqueue_to(const DeviceArray<uint>& display, const Radiance& radiance, float exposure_ev,
                    StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<float> boundary_;
    GrowingArray<uint> code_, display_;
};

}  // namespace kilolux
