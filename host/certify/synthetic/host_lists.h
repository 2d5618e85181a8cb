// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/certify/synthetic/synthetic.h"
#include "host/lighting/deferred_lighting.h"

namespace kilolux {

/// Lists on the host, indices widened to 32 bits.
struct HostLists {
    std::vector<uint> coarse_offsets, coarse;
    std::vector<uint> cluster_offsets;  // of the fine tiles
    std::vector<ActiveCluster> clusters;
    std::vector<uint> refined;

    std::span<const uint> coarse_of(std::size_t cluster) const {
        return std::span(coarse).subspan(coarse_offsets[cluster],
                                         coarse_offsets[cluster + 1] - coarse_offsets[cluster]);
    }
    std::span<const uint> refined_of(const ActiveCluster& c) const {
        return std::span(refined).subspan(c.list_begin, c.list_count);
    }
    /// The active cluster of a fine tile and slice; null if there is none.
    const ActiveCluster* find(uint tile, uint slice) const;
    /// The list that shading walks for a pixel; empty if it has no active cluster.
    std::span<const uint> list_at(const ClusterGrid& grid, const Planes& planes, uint x,
                                  uint y) const;
};

HostLists download_lists(const Gpu& gpu, const KernelFeatures& features, const ListedLights& lists);

/// LightLists with coarse lists of clusters without pixels, too: for checks of every coarse list.
ListedLights list_everywhere(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                             const LightingInput& input);

/// A text that is equal if and only if the lists are; their places in memory do not count.
std::string fingerprint(const HostLists& lists);

}  // namespace kilolux
