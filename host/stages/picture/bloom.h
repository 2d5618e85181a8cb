// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

StageWork bloom_work(const StageCounts& counts);
inline constexpr StageInfo kBloomStage = {"bloom", StageGroup::picture, bloom_work};

/// Light that spreads in the eye or lens: the image mixed with wide blurs of itself.
class Bloom {
 public:
    /// Bytes of a pixel: the result, and the smaller levels.
    static constexpr std::size_t kPixelBytes = 3 * sizeof(float) * 4 / 3;

    explicit Bloom(const Gpu& gpu);

    /// (1 - share) * radiance + share * blurred radiance, share in [0, 1]; 0 returns `radiance`
    /// itself. The blur is a mean over octaves of width up to a sixteenth of the image; it has the
    /// image's mean, up to half pixels at borders of odd size. Negative light and NaN do not
    /// spread. Enqueues only; `radiance` stays as it is.
    Radiance enqueue(const Radiance& radiance, float share, StageTimer& timer);

 private:
    Gpu gpu_;
    KernelProgram program_;
    Kernel down_, up_;
    std::vector<GrowingArray<float>> levels_;  // [0]: the result; [i]: the image 2^i times smaller
};

}  // namespace kilolux
