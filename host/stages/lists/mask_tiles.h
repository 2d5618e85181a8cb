// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kMaskTilesStage = {"mask_tiles", StageGroup::surfaces};

/// Copies triangle ids; fine tiles that need no more samples become background.
class MaskTiles {
 public:
    static constexpr std::size_t kPixelBytes = sizeof(uint);  // an id

    MaskTiles(const Gpu& gpu, const Tuning& tuning);

    /// Of ids[view.height][view.stride]. Valid until the next call. Enqueues only.
    DeviceArray<uint> enqueue(const TileCounts& done, const View& view,
                              const DeviceArray<uint>& ids, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<uint> masked_;
};

}  // namespace kilolux
