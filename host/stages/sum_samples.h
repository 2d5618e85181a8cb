// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// Mean of pictures, summed with more bits than float64 has and rounded once.
class SumSamples {
 public:
    SumSamples(const Gpu& gpu, const Tuning& tuning);

    /// Forgets all pictures.
    void clear() { count_ = 0; }

    /// Adds a picture; all must have the same size. Enqueues only.
    void add(const Radiance& radiance, StageTimer& timer);

    /// The mean of at least one picture. Valid until the next call. Enqueues only.
    Radiance mean(StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    cl::Program program_;
    View view_{};
    int count_ = 0;
    GrowingBuffer sums_, mean_;
};

}  // namespace kilolux
