// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/mask_tiles.h"

namespace kilolux {

MaskTiles::MaskTiles(const Gpu& gpu, const Tuning& tuning)
    : tuning_(tuning),
      kernel_(gpu, build_program(gpu, kMaskTilesStage), kMaskTilesStage, "mask_tiles"),
      masked_(gpu, kMaskTilesStage) {}

DeviceArray<uint> MaskTiles::enqueue(const TileCounts& done, const View& view,
                                     const DeviceArray<uint>& ids, StageTimer& timer) {
    auto out = masked_.reserve(std::size_t{view.stride} * view.height);
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, view, done.fixed, ids,
                    out);
    return out;
}

}  // namespace kilolux
