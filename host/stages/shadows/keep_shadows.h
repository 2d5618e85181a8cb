// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

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

    /// Copies a frame's complete lists and shadows, `words` of them, before another frame
    /// overwrites them. Nothing is kept where device or budget have no room for the copies and for
    /// as much again. Enqueues only.
    void save(const LitPixels& lit, const ShadowWords& shadows, std::uint64_t words);

    /// Releases them.
    void forget();

    /// Fills in the words, `words` of them, of lights that have the positions and ranges of the
    /// saved frame, and returns which these are: ShadowTargets::kept. Without a saved frame of the
    /// same pixels and grid: none. Valid until the next call. Enqueues only.
    DeviceArray<uint> enqueue(const LitPixels& lit, const ShadowWords& shadows, std::uint64_t words,
                              StageTimer& timer);

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
    template <typename T>
    DeviceArray<T> copy(GrowingArray<T>& to, const DeviceArray<T>& from, std::size_t count);
    ShadowsBefore copy(const LitPixels& lit, const ShadowWords& shadows, std::uint64_t words);

    Gpu gpu_;
    Tuning tuning_;
    std::string stage_;
    Kernel kernel_;
    GrowingArray<uint> kept_;
    std::optional<Copies> copies_;
    std::optional<ShadowsBefore> before_;  // in copies_
    std::uint64_t gbuffer_ = 0;            // version of the saved frame's
    ClusterGrid grid_{};                   // of the saved frame
};

}  // namespace kilolux
