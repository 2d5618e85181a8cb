// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/kernel.h"

namespace kilolux {

/// The order of tiles by their number of entries, the most first, to a factor of 1.5.
class OrderTiles {
 public:
    /// Times and errors count to `stage`.
    OrderTiles(const Gpu& gpu, const Tuning& tuning, std::string_view stage);

    /// Each of the tiles once. `offsets`: exclusive sums of their entries, and the total. Valid
    /// until the next call. Enqueues only.
    DeviceArray<uint> enqueue(const DeviceArray<uint>& offsets, uint tiles, StageTimer& timer);

 private:
    int group_;
    Kernel kernel_;
    GrowingArray<uint> order_;
};

}  // namespace kilolux
