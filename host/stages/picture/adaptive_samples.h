// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kAdaptiveSamplesStage = {"adaptive_samples", StageGroup::picture};

/// Means of as many pictures as each fine tile needs. The pictures are in two halves, and each
/// half's spread decides where the other's mean stops, so that the means are unbiased.
class AdaptiveSamples {
 public:
    static constexpr std::size_t kStatePlanes = 5;  // of a half: STATE_PLANES of the kernel
    /// Bytes of a pixel: both halves, the mean and its variance; and taken().
    static constexpr std::size_t kPixelBytes =
        (2 * kStatePlanes + 3 + 1) * sizeof(float) + sizeof(uint);

    AdaptiveSamples(const Gpu& gpu, const Tuning& tuning);

    /// Forgets all pictures.
    void clear() { taken_[0] = taken_[1] = 0; }

    /// Adds a picture to half 0 or 1; all must have the same size. Enqueues only.
    void add(uint half, const Radiance& radiance, StageTimer& timer);

    /// Call after as many pictures of each half, at least two. Stops the means whose standard error
    /// of the luminance, over sqrt(luminance^2 + floor^2), is at most `error`, root mean square
    /// over the pixels of a fine tile. Enqueues only.
    void decide(float error, float floor, StageTimer& timer);

    /// Which fine tiles need more. Blocks.
    std::vector<bool> open_tiles() const;
    uint tile_count() const { return fine_tile_count(view_); }
    const View& view() const { return view_; }

    /// The counts at which means stopped, as MaskTiles reads them.
    TileCounts done() const { return {fixed_.get()}; }

    /// The mean of both halves. Valid until the next call. Enqueues only.
    Radiance mean(StageTimer& timer);

    /// Of each pixel's luminance in the last mean(), [height][stride].
    DeviceArray<float> variance() const { return variance_.get(); }

    /// Pictures that each pixel of the planes took, [height][stride], 0 beyond the width. Blocks.
    std::vector<uint> taken() const;

 private:
    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel add_, decide_, mean_kernel_;
    View view_{};
    uint taken_[2] = {0, 0};
    GrowingArray<uint> fixed_;   // [2][tiles]
    GrowingArray<float> state_;  // [2][5][height][stride]
    GrowingArray<float> mean_, variance_;
};

}  // namespace kilolux
