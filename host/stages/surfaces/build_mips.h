// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "kernels/shared/surface_scene.h"

namespace kilolux {

inline constexpr StageInfo kBuildMipsStage = {"build_mips", StageGroup::surfaces};

/// 8-bit images -> linear texels of 16 bits a channel, with mip levels.
class BuildMips {
 public:
    explicit BuildMips(const Gpu& gpu, const Tuning& tuning);

    /// The levels of one image, at the places that `row` names. `rgba`: rows from the top. `srgb`:
    /// colours are sRGB codes. Returns when `rgba` was read.
    void enqueue(std::span<const std::uint8_t> rgba, bool srgb, const TextureRow& row,
                 const DeviceArray<std::uint64_t>& texels);

 private:
    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel first_, next_;
    GrowingArray<std::uint16_t> srgb_, linear_;
    GrowingArray<std::uint8_t> image_;
};

}  // namespace kilolux
