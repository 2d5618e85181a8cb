// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/coarse_stages.h"

namespace kilolux {

CoarseStages::CoarseStages(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      index_bits_(features.light_index_bits),
      prepare_(gpu, tuning),
      build_(gpu),
      cull_(gpu, tuning, features) {}

CoarseResult CoarseStages::enqueue(const LightInput& input, const View& view,
                                   const ClusterGrid& grid, StageTimer& timer,
                                   const DeviceArray<std::uint8_t>& occupied) {
    CoarseResult out;
    out.lights = prepare_.enqueue(input, view, grid, timer);
    out.boxes = build_.enqueue(view, grid, timer);
    out.lists = cull_.enqueue(out.lights, out.boxes, timer, occupied);
    return out;
}

HostCoarseLists CoarseStages::download(const CoarseResult& result) const {
    HostCoarseLists out;
    out.grid = result.boxes.grid;
    out.offsets = kilolux::download<uint>(gpu_, result.lists.offsets,
                                          std::size_t{out.grid.cluster_count} + 1);
    out.lists = download_indices(gpu_, result.lists.lists, index_bits_, out.offsets.back());
    return out;
}

}  // namespace kilolux
