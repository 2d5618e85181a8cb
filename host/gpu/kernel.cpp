// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/kernel.h"

#include "kernels/shared/cluster_grid.h"

namespace kilolux {

WorkSize pixel_items(const View& view, int lanes, int rows) {
    const auto width = static_cast<std::size_t>(FINE_TILE / lanes);
    const auto height = static_cast<std::size_t>(rows);
    return {cl::NDRange(view.stride / FINE_TILE * width, round_up(view.height, height)),
            cl::NDRange(width, height)};
}

WorkSize block_items(const View& view, int lanes, int rows) {
    View tiles = view;
    tiles.height = static_cast<uint>(round_up(view.height, FINE_TILE));
    return pixel_items(tiles, lanes, rows);
}

Kernel::Kernel(const Gpu& gpu, const cl::Program& program, std::string_view stage, const char* name)
    : queue_(gpu.queue),
      kernel_(in_stage(stage, [&] { return cl::Kernel(program, name); })),
      stage_(stage) {}

cl::Event Kernel::launch(const WorkSize& size) {
    cl::Event event;
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, size.global, size.local, nullptr, &event);
    return event;
}

}  // namespace kilolux
