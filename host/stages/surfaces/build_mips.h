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

/// Linear texels of 16 bits a channel -> their mip levels.
class BuildMips {
 public:
    explicit BuildMips(const Gpu& gpu, const Tuning& tuning);

    /// The levels of one image, at the places that `row` names. Returns when `first` was read.
    void enqueue(std::span<const std::uint64_t> first, const TextureRow& row,
                 const DeviceArray<std::uint64_t>& texels);

 private:
    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel next_;
};

}  // namespace kilolux
