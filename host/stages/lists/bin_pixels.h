// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/gpu/flow.h"
#include "host/gpu/stage_info.h"
#include "host/stages/lists/prefix_sum.h"

namespace kilolux {

StageWork bin_pixels_work(const StageCounts& counts);
inline constexpr StageInfo kBinPixelsStage = {"bin_pixels", StageGroup::lists, bin_pixels_work};

/// Finds the active clusters: per fine tile, one for each slice among its pixels, with the box of
/// its pixels. Orders the tile's pixels by cluster.
class BinPixels {
 public:
    /// Bytes of a pixel: its place in the tile's order, and its share of the active clusters, about
    /// two a tile, with their lists and the sums of both.
    static constexpr std::size_t kPixelBytes = 2;

    BinPixels(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// `occupied`: marks of other pixels' clusters in the same grid, to which these are added;
    /// none: they are marked alone. Enqueues only.
    ActiveClusters enqueue(const GBuffer& gbuffer, const ClusterGrid& grid, StageTimer& timer,
                           const DeviceArray<std::uint8_t>& occupied = {});

    /// Active clusters of the last enqueue: on the device; on the host, which blocks.
    DeviceArray<std::uint64_t> total() const { return clusters_.total(); }
    std::uint64_t active() const { return clusters_.read_total(); }

    /// True if there is room for the last enqueue's `active` clusters; else makes room for the
    /// next. Without a number it blocks to read it.
    bool fits(std::uint64_t active) { return clusters_.fits(active); }
    bool fits() { return fits(active()); }

 private:
    Tuning tuning_;
    KernelProgram program_;
    Kernel clear_, count_, fill_;
    CountedList clusters_;
    GrowingArray<std::uint8_t> order_, occupied_;
};

}  // namespace kilolux
