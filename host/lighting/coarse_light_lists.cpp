// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/coarse_light_lists.h"

#include "host/gpu/repeat_until_fits.h"
#include "host/lighting/check_input.h"

namespace kilolux {

CoarseLightLists::CoarseLightLists(const Gpu& gpu, const Tuning& tuning,
                                   const KernelFeatures& features)
    : gpu_(gpu),
      index_bits_(features.light_index_bits),
      prepare_(gpu, tuning),
      build_(gpu),
      cull_(gpu, tuning, features) {}

CoarseLighting CoarseLightLists::run(const LightInput& input, const View& view,
                                     const ClusterGrid& grid, StageTimer& timer) {
    return repeat_until_fits(
        timer, [&] { return enqueue(input, view, grid, timer); }, [&] { return fits(pairs()); });
}

CoarseLighting CoarseLightLists::enqueue(const LightInput& input, const View& view,
                                         const ClusterGrid& grid, StageTimer& timer,
                                         const DeviceArray<std::uint8_t>& occupied) {
    check_input(input);
    check_input(grid, view);
    CoarseLighting out;
    out.lights = prepare_.enqueue(input, view, grid, timer);
    out.boxes = build_.enqueue(view, grid, timer);
    out.lists = cull_.enqueue(out.lights, out.boxes, timer, occupied);
    return out;
}

HostCoarseLists CoarseLightLists::download(const CoarseLighting& coarse) const {
    HostCoarseLists out;
    out.grid = coarse.boxes.grid;
    out.offsets = kilolux::download(gpu_, coarse.lists.offsets);
    out.lists = download_indices(gpu_, coarse.lists.lists, index_bits_, out.offsets.back());
    return out;
}

}  // namespace kilolux
