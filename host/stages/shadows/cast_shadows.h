// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"
#include "host/stages/lists/order_tiles.h"
#include "host/stages/lists/prefix_sum.h"

namespace kilolux {

StageWork cast_shadows_work(const StageCounts& counts);
inline constexpr StageInfo kCastShadowsStage = {"cast_shadows", StageGroup::shadows,
                                                cast_shadows_work};

/// Casts the shadows of the lights in each active cluster's list onto the cluster's pixels.
class CastShadows {
 public:
    /// Tuning::shadow_group 0: one walk for each light and vector of pixels. `counts`: the kernels
    /// count their walks, rays, nodes, triangles and tests, for measurements.
    CastShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                const SurfaceFeatures& surfaces, bool counts = false);

    /// Makes room for the words, and sets first_pixel and first_word of the clusters. If fits() was
    /// true since the last call, it uses the room that there is and does not block; else it blocks
    /// for the number of words, and throws Error when the device cannot hold them. Valid until the
    /// next call. `slots`: of each light of a list; 1, or slots_of_light() of
    /// kernels/shared/shadow.h for sampled shadows in scenes with area lights.
    ShadowWords reserve(const PreparedLights& lights, const ActiveClusters& clusters,
                        StageTimer& timer, uint slots = 1);

    /// Casts into what reserve() returned, but for what is kept there; with
    /// KernelFeatures::sampled_shadows the words hold what DrawShadows picked by `samples`.
    /// Enqueues only.
    void enqueue(const ShadowInput& input, const LitPixels& lit, const ShadowTargets& to,
                 StageTimer& timer, const ShadowSamples& samples = {});

    /// False where the last reserve(), for complete lists, had no room: nothing was cast, and the
    /// next one makes it. Waits for the number of words.
    bool fits();

    /// Words of 32 bits of the last reserve(); where it did not block, known from fits() on.
    std::uint64_t words() const { return word_count_; }

    /// What the last enqueue() counted; without words. Blocks.
    ShadowCounts counts() const;

 private:
    WorkSize work_size(uint tiles, const View& view) const;

    Gpu gpu_;
    Tuning tuning_;
    bool is_sampled_;
    bool has_counts_;
    KernelProgram program_;
    Kernel reserve_, cast_;
    CountedList words_;
    std::uint64_t word_count_ = 0;
    bool is_counted_ = false;            // word_count_ is that of the last reserve()
    bool may_skip_wait_ = false;         // the next reserve() may
    GrowingArray<ShadowCounts> counts_;  // of work-items or groups
    std::optional<OrderTiles> order_;    // in which work-groups take them
};

}  // namespace kilolux
