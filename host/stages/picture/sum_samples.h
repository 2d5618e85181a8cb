// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kSumSamplesStage = {"sum_samples", StageGroup::picture};

/// Mean of pictures and of their groups' light, summed with more bits than float64 has and rounded
/// once.
class SumSamples {
 public:
    static constexpr std::size_t kSumFloats = 3;  // of a value
    /// Bytes of a pixel's radiance, and of that of each group: the sums and the mean.
    static constexpr std::size_t kPixelBytes = 3 * (kSumFloats + 1) * sizeof(float);

    SumSamples(const Gpu& gpu, const Tuning& tuning);

    /// Forgets all pictures.
    void clear() { count_ = 0; }

    /// Adds a picture; all must have the same size and groups. Enqueues only.
    void add(const Radiance& radiance, StageTimer& timer);

    /// The mean of at least one picture. Valid until the next call. Enqueues only.
    Radiance mean(StageTimer& timer);

 private:
    WorkSize work_size() const;

    int group_;
    KernelProgram program_;
    Kernel add_, mean_kernel_;
    Radiance last_;  // that was added
    uint count_ = 0;
    GrowingArray<float> sums_, mean_;
};

}  // namespace kilolux
