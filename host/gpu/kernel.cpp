// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/kernel.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "kernels/shared/cluster_grid.h"

namespace kilolux {

namespace {

// PoCL 3.1 ends the program where it chooses groups for a device that allows fewer work-items than
// its preferred multiple.
constexpr std::size_t kLargestThatDriversMissize = 32;

WorkSize in_groups_of_one(const WorkSize& size) {
    const cl::NDRange ones[] = {cl::NDRange(1), cl::NDRange(1, 1), cl::NDRange(1, 1, 1)};
    return {size.global, ones[size.global.dimensions() - 1]};
}

}  // namespace

WorkSize fit_groups(const WorkSize& size, std::size_t largest, std::string_view stage) {
    const bool driver_chooses = size.local.dimensions() == 0;
    if (driver_chooses && largest <= kLargestThatDriversMissize) return in_groups_of_one(size);
    std::size_t group = 1;
    for (std::size_t i = 0; i < size.local.dimensions(); ++i) group *= size.local.get()[i];
    if (group <= largest) return size;
    if (size.is_fixed || size.local.dimensions() != 1) {
        throw Error(std::string(stage) + ": groups of " + std::to_string(group) +
                    " work-items; the device allows this kernel groups of " +
                    std::to_string(largest));
    }
    return {size.global, cl::NDRange(std::bit_floor(largest))};  // divides a larger power of two
}

WorkSize Kernel::pixel_items(const View& view, int rows) const {
    const std::size_t largest = made().largest_group;
    const std::size_t width = std::min(FINE_TILE / lanes(), std::bit_floor(largest));
    const std::size_t most = std::bit_floor(std::max<std::size_t>(largest / width, 1));
    const std::size_t height = std::min(static_cast<std::size_t>(rows), most);
    return {cl::NDRange(view.stride / lanes(), round_up(view.height, height)),
            cl::NDRange(width, height)};
}

WorkSize Kernel::block_items(const View& view, int rows) const {
    View tiles = view;
    tiles.height = static_cast<uint>(round_up(view.height, FINE_TILE));
    return pixel_items(tiles, rows);
}

Kernel::Kernel(const Gpu& gpu, KernelProgram program, std::string_view stage, const char* name)
    : queue_(gpu.queue),
      device_(gpu.device),
      program_(std::move(program)),
      stage_(stage),
      name_(name),
      checks_arguments_(gpu.checks_arguments),
      tables_(in_stage(stage, [&] { return device_tables(gpu); })) {
    if (!gpu.programs->builds_in_background()) made();
}

Kernel::Made& Kernel::made() const {
    if (made_) return *made_;
    in_stage(stage_, [&] {
        const auto start = StageTimer::Clock::now();
        Made made;
        made.kernel = cl::Kernel(program_.built(), name_);
        made.wait = {start, StageTimer::Clock::now()};
        made.largest_group = made.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_);
        if (checks_arguments_) made.parameters = parameters_of(made.kernel);
        made_ = std::move(made);
    });
    return *made_;
}

void Kernel::compare_argument(cl_uint index, std::string_view name, std::string_view type,
                              bool is_memory) const {
    const KernelParameter& parameter = made().parameters.at(index);
    if (accepts(parameter, name, type, is_memory)) return;
    throw Error(stage_ + ": argument " + std::to_string(index) + " is '" + std::string(name) +
                "' of type " + std::string(type) + (is_memory ? "*" : "") +
                "; the kernel's parameter is '" + parameter.name + "' of type " + parameter.type);
}

void Kernel::take_wait(StageTimer& timer) {
    if (!made().wait) return;
    timer.record_build(made().wait->front(), made().wait->back());
    made().wait.reset();
}

bool Kernel::is_first_launch(const cl::NDRange& group) {
    std::array<std::size_t, 3> size = {1, 1, 1};
    std::copy_n(group.get(), group.dimensions(), size.begin());
    auto& launched = made().launched;
    if (std::ranges::find(launched, size) != launched.end()) return false;
    launched.push_back(size);
    return true;
}

cl::Event Kernel::launch(const WorkSize& size) {
    const WorkSize fitting = fit_groups(size, made().largest_group, stage_);
    cl::Event event;
    queue_.enqueueNDRangeKernel(made().kernel, cl::NullRange, fitting.global, fitting.local,
                                nullptr, &event);
    return event;
}

}  // namespace kilolux
