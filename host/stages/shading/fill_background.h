// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

StageWork fill_background_work(const StageCounts& counts);
inline constexpr StageInfo kFillBackgroundStage = {"fill_background", StageGroup::picture,
                                                   fill_background_work};

/// The light of an environment where no surface covers a pixel: bilinear in its texels, of the
/// level whose texels are at most about as large as a pixel in the picture's middle.
class FillBackground {
 public:
    /// Bytes of an image of so many texels: all levels.
    static constexpr std::uint64_t bytes(std::uint64_t texels) {
        return texels * 3 * sizeof(float) * 4 / 3;
    }

    FillBackground(const Gpu& gpu, const Tuning& tuning);

    /// The environment: float[height][width][3], longitude by latitude, its middle column towards
    /// -Z, its first row towards +Y. Blocks.
    void set_image(std::span<const float> rgb, uint width, uint height);

    /// Fills the pixels of `radiance` where the G-buffer has no surface. Enqueues only.
    void enqueue(const GBuffer& gbuffer, const Radiance& radiance, StageTimer& timer);

    /// Fills all pixels, before OpenGL draws over them. Enqueues only.
    void enqueue_everywhere(const Radiance& radiance, StageTimer& timer);

 private:
    uint4 level_for(const View& view) const;

    Gpu gpu_;
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<float> texels_;
    std::vector<uint4> levels_;  // width, height and first texel, each level half of the one before
};

}  // namespace kilolux
