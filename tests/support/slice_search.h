// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/shared/cluster_grid.h"

namespace kilolux {

/// The grid whose slices are those of active clusters.
inline ClusterGrid fine_grid(ClusterGrid grid) {
    grid.slices_per_octave <<= grid.fine_slice_bits;
    grid.slices <<= grid.fine_slice_bits;
    return grid;
}

/// Slice of a depth by comparing with the ends of the slices.
inline uint slice_by_search(const ClusterGrid& grid, double z) {
    uint slice = 0;
    while (slice + 1 < grid.slices && z >= depth_of_slice(grid, slice + 1)) ++slice;
    return slice;
}

}  // namespace kilolux
