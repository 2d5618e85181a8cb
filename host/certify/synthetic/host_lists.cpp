// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/host_lists.h"

#include <algorithm>

namespace kilolux {

const ActiveCluster* HostLists::find(uint tile, uint slice) const {
    for (uint i = cluster_offsets[tile]; i < cluster_offsets[tile + 1]; ++i) {
        if (clusters[i].slice == slice) return &clusters[i];
    }
    return nullptr;
}

std::span<const uint> HostLists::list_at(const ClusterGrid& grid, const Planes& planes, uint x,
                                         uint y) const {
    const uint slice = fine_slice_of_depth(grid, planes.at(SURFACE_DEPTH, x, y));
    const ActiveCluster* cluster = find(fine_tile_of(planes.view, x, y), slice);
    return cluster == nullptr ? std::span<const uint>() : refined_of(*cluster);
}

HostLists download_lists(const Gpu& gpu, const KernelFeatures& features,
                         const ListedLights& lists) {
    const int bits = features.light_index_bits;
    HostLists out;
    out.coarse_offsets =
        download<uint>(gpu, lists.coarse.offsets, std::size_t{lists.grid.cluster_count} + 1);
    out.coarse = download_indices(gpu, lists.coarse.lists, bits, out.coarse_offsets.back());
    out.cluster_offsets =
        download<uint>(gpu, lists.clusters.offsets, std::size_t{lists.clusters.tile_count} + 1);
    out.clusters =
        download<ActiveCluster>(gpu, lists.clusters.clusters, out.cluster_offsets.back());
    std::size_t end = 0;
    for (const ActiveCluster& c : out.clusters) {
        end = std::max<std::size_t>(end, c.list_begin + c.list_count);
    }
    out.refined = download_indices(gpu, lists.refined.lists, bits, end);
    return out;
}

ListedLights list_everywhere(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                             const LightingInput& input) {
    LightLists lists(gpu, tuning, features);
    lists.list_everywhere();
    StageTimer timer;
    return lists.run(input.lights, input.gbuffer, input.grid, timer);
}

std::string fingerprint(const HostLists& lists) {
    std::string text;
    const auto add = [&](const auto* values, std::size_t count) {
        const std::size_t bytes = count * sizeof(*values);
        text.append(reinterpret_cast<const char*>(&count), sizeof(count));
        text.append(reinterpret_cast<const char*>(values), bytes);
    };
    add(lists.coarse_offsets.data(), lists.coarse_offsets.size());
    add(lists.coarse.data(), lists.coarse.size());
    add(lists.cluster_offsets.data(), lists.cluster_offsets.size());
    for (ActiveCluster c : lists.clusters) {
        const auto list = lists.refined_of(c);
        c.list_begin = 0;
        add(&c, 1);
        add(list.data(), list.size());
    }
    return text;
}

}  // namespace kilolux
