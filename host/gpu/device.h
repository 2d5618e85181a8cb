// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/gpu/memory_budget.h"

namespace kilolux {

/// What an OpenCL device says of itself.
struct DeviceInfo {
    std::string name;
    std::string version;  // CL_DEVICE_VERSION
    std::string driver;
    std::string platform;
    bool is_cpu = false;
    int lane_width = 1;  // floats that a kernel's FV holds here
    int compute_units = 1;
    int max_work_group = 1;         // work-items of a work-group
    std::uint64_t cache_bytes = 0;  // of the largest cache that global memory has; 0: unknown
    std::uint64_t memory_bytes = 0;
    std::uint64_t max_allocation_bytes = 0;
};

DeviceInfo describe(const cl::Device& device);

/// Every device of every platform; empty when there is none.
std::vector<cl::Device> all_devices();

/// The device meant by `choice`: an index into all_devices(), or a part of its name (any case);
/// empty: the first GPU, else the first device. Throws Error that lists what there is.
cl::Device choose_device(std::string_view choice);

/// A device with its context and an in-order, profiling queue: what every stage is given.
///
/// Copies share the same OpenCL objects. A caller that owns a context and queue passes them in; the
/// queue must have profiling enabled for stage times.
struct Gpu {
    explicit Gpu(const cl::Device& device, int lane_width = 0);
    Gpu(cl::Context context, cl::CommandQueue queue, int lane_width = 0);

    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;
    DeviceInfo info;
    std::shared_ptr<MemoryBudget> budget;  // of GrowingBuffers; none: what the device has
};

}  // namespace kilolux
