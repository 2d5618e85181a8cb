// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kAdaptiveSamplesStage = {"adaptive_samples", StageGroup::picture};

/// Means of as many pictures as each fine tile needs, and of their groups' light. The pictures are
/// in two halves, and each half's spread decides where the other's mean stops, so that the means
/// are unbiased.
class AdaptiveSamples {
 public:
    static constexpr uint kLuminancePlanes = 2;  // of a half: state_planes() of the kernels
    /// Bytes of a pixel without its radiance: luminance of both halves, its variance, taken().
    static constexpr std::size_t kPixelBytes =
        (2 * kLuminancePlanes + 1) * sizeof(float) + sizeof(uint);
    /// Bytes of a pixel's radiance, of the picture or of one group: both halves and the mean.
    static constexpr std::size_t kRadianceBytes = 3 * (2 + 1) * sizeof(float);
    /// Floats of a pixel in one buffer, of `groups` of lights.
    static constexpr std::size_t state_floats(std::size_t groups) {
        return 2 * (3 * (1 + groups) + kLuminancePlanes);
    }

    AdaptiveSamples(const Gpu& gpu, const Tuning& tuning);

    /// Forgets all pictures.
    void clear() { taken_[0] = taken_[1] = 0; }

    /// Adds a picture to half 0 or 1; all must have the same size and groups. Enqueues only.
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
    // The sizes of a half's state.
    struct Shape {
        View view{};
        uint planes = 3;  // of a Radiance
        void each(auto&& set) const {
            set("view", view);
            set("planes", planes);
        }
    };
    Shape shape() const { return {view_, 3 * (1 + groups_)}; }

    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel add_, decide_, mean_kernel_;
    View view_{};
    uint groups_ = 0;
    uint taken_[2] = {0, 0};
    GrowingArray<uint> fixed_;   // [2][tiles]
    GrowingArray<float> state_;  // [2][planes + kLuminancePlanes][height][stride]
    GrowingArray<float> mean_, variance_;
};

}  // namespace kilolux
