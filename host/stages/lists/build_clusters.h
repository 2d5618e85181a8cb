// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

StageWork build_clusters_work(const StageCounts& counts);
inline constexpr StageInfo kBuildClustersStage = {"build_clusters", StageGroup::lists,
                                                  build_clusters_work};

/// The parameters of a coarse grid.
struct GridRequest {
    uint tiles_x = 16;  // wanted; tile edges become multiples of 16 pixels
    uint tiles_y = 9;
    uint slices_per_octave = 4;  // 1..64
    float z_first = 0.1f;   // [m] > 0: where the slices start to grow; nearer pixels share slice 0
    float z_last = 100.0f;  // [m]: farther pixels share the last slice
    float position_pad = 0.0f;  // [m]: see ClusterGrid
    /// Slices of active clusters: rounded down to slices_per_octave times a power of two.
    uint fine_per_octave = 16;
};

/// The grid for an image. Values out of range are clamped to the nearest that works. Throws Error
/// for more tiles or clusters than kernels can number.
ClusterGrid make_cluster_grid(const GridRequest& request, uint width, uint height);

/// Boxes of the coarse clusters in view space.
class BuildClusters {
 public:
    explicit BuildClusters(const Gpu& gpu);

    /// Enqueues only.
    ClusterBoxes enqueue(const View& view, const ClusterGrid& grid, StageTimer& timer);

 private:
    Kernel kernel_;
    GrowingArray<BoxInterval> columns_, rows_, depths_;
};

}  // namespace kilolux
