// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/surface_flow.h"
#include "kernels/shared/clusters.h"

namespace kilolux {

/// A frame's shadow words and how many they are.
struct CountedWords {
    ShadowWords shadows;
    std::uint64_t count = 0;
};

/// Copies of a frame's exact shadows and of what they belong to, for a frame of the same pixels and
/// grid.
struct ShadowsBefore {
    DeviceArray<float4> bounds;  // [light_count], see PreparedLights
    uint light_count = 0;
    DeviceArray<DirectionalLight> directional;
    uint directional_count = 0;
    DeviceArray<ActiveCluster> clusters;
    LightIndexBytes lists;
    ShadowWords shadows;

    void each(auto&& set) const {  // BEFORE_ARGS
        set("bounds_before", bounds);
        set("count_before", light_count);
        set("directional_before", directional);
        set("directional_count_before", directional_count);
        set("clusters_before", clusters);
        set("lists_before", lists);
        set("word_offsets_before", shadows.offsets);
        set("words_before", shadows.words);
    }
};

/// Keeps the exact shadows of lights that stand still, light by light and cluster by cluster.
class KeepShadows {
 public:
    /// Times and errors count to `stage`.
    KeepShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                std::string_view stage);

    /// Copies a frame's complete lists, of `counts`, and shadows before another frame overwrites
    /// them. Nothing is kept where device or budget have no room for the copies and for as much
    /// again. Enqueues only.
    void save(const LitPixels& lit, const CountedWords& words, const PairCounts& counts,
              StageTimer& timer);

    /// Releases the copies.
    void forget();

    /// Fills in the words of lights that have the positions and ranges of the saved frame, and
    /// returns which these are: ShadowTargets::kept. Without a saved frame of the same pixels and
    /// grid: none. Valid until the next call. Enqueues only.
    DeviceArray<uint> enqueue(const LitPixels& lit, const ShadowWords& words, StageTimer& timer);

 private:
    struct Copies {
        Copies(const Gpu& gpu, std::string_view stage);
        GrowingArray<float4> bounds;
        GrowingArray<DirectionalLight> directional;
        GrowingArray<ActiveCluster> clusters;
        GrowingArray<std::byte> lists;
        GrowingArray<uint> offsets, words;
    };

    bool has_room(std::uint64_t bytes) const;
    ShadowsBefore copy(const LitPixels& lit, const CountedWords& words, const PairCounts& counts,
                       StageTimer& timer);

    Gpu gpu_;
    Tuning tuning_;
    KernelFeatures features_;
    std::string stage_;
    std::optional<Kernel> kernel_;  // once anything was saved
    GrowingArray<uint> kept_;
    std::optional<Copies> copies_;
    std::optional<ShadowsBefore> before_;  // in copies_
    std::uint64_t gbuffer_version_ = 0;    // of the saved frame
    ClusterGrid grid_{};                   // likewise
};

}  // namespace kilolux
