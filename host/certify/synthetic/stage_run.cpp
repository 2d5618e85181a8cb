// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/stage_run.h"

#include <string>

namespace kilolux {

StageRun::StageRun(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : prepare_(gpu, tuning),
      build_(gpu),
      cull_(gpu, tuning, features),
      bin_(gpu, tuning, features),
      refine_(gpu, tuning, features) {}

DeviceLists StageRun::run(const LightInput& lights, const GBuffer& gbuffer,
                          const ClusterGrid& grid) {
    StageTimer timer;
    DeviceLists out;
    out.lights = prepare_.enqueue(lights, gbuffer.view, grid, timer);
    out.boxes = build_.enqueue(gbuffer.view, grid, timer);
    do {
        out.coarse = cull_.enqueue(out.lights, out.boxes, timer);
    } while (!cull_.fits());
    do {
        out.clusters = bin_.enqueue(gbuffer, grid, timer);
    } while (!bin_.fits());
    do {
        out.refined =
            refine_.enqueue(out.lights, out.coarse, out.clusters, gbuffer.view, grid, timer);
    } while (!refine_.fits());
    return out;
}

const ActiveCluster* HostLists::find(uint tile, uint slice) const {
    for (uint i = cluster_offsets[tile]; i < cluster_offsets[tile + 1]; ++i) {
        if (clusters[i].slice == slice) return &clusters[i];
    }
    return nullptr;
}

HostLists download_lists(const Gpu& gpu, const KernelFeatures& features, const ClusterGrid& grid,
                         const DeviceLists& lists) {
    const int bits = features.light_index_bits;
    HostLists out;
    out.coarse_offsets =
        download<uint>(gpu, lists.coarse.offsets, std::size_t{grid.cluster_count} + 1);
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

Planes decode(const Gpu& gpu, const KernelFeatures& features, const GBuffer& gbuffer) {
    StageTimer timer;
    DecodeGBuffer stage(gpu, default_tuning(gpu.info), features);
    const cl::Buffer planes = stage.enqueue(gbuffer, timer);
    const View& view = gbuffer.view;
    return {view, download<float>(gpu, planes,
                                  std::size_t{stage.plane_count()} * view.stride * view.height)};
}

ClusterGrid fine_grid(ClusterGrid grid) {
    grid.slices_per_octave <<= grid.fine_slice_bits;
    grid.slices <<= grid.fine_slice_bits;
    return grid;
}

uint slice_by_search(const ClusterGrid& grid, double z) {
    uint slice = 0;
    while (slice + 1 < grid.slices && z >= depth_of_slice(grid, slice + 1)) ++slice;
    return slice;
}

}  // namespace kilolux
