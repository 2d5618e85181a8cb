// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

StageWork tonemap_work(const StageCounts& counts);
inline constexpr StageInfo kTonemapStage = {"tonemap", StageGroup::picture, tonemap_work};

/// Linear radiance to 8-bit sRGB.
class Tonemap {
 public:
    /// `tone_curve`: TONE_CURVE_*.
    Tonemap(const Gpu& gpu, const Tuning& tuning, int tone_curve);

    /// The codes of `radiance`, in this stage's own memory. Enqueues only.
    DeviceArray<uint> enqueue(const Radiance& radiance, float exposure_ev, StageTimer& timer);

    /// The same to a target that this stage has made. Enqueues only.
    void enqueue(const Radiance& radiance, const DisplayTarget& to, StageTimer& timer,
                 const Backdrop& backdrop = {});

    /// A target in this stage's own memory, or in the caller's, which has room for all pixels.
    DisplayTarget target(const View& view, float exposure_ev);
    DisplayTarget target(DeviceArray<uint> pixels, const View& view, float exposure_ev) const;

 private:
    Tuning tuning_;
    int tone_curve_;
    Kernel kernel_;
    GrowingArray<uint> display_;
};

}  // namespace kilolux
