// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/gpu/memory/memory_budget.h"

namespace kilolux {

/// Properties of an OpenCL device.
struct DeviceInfo {
    std::string name;
    std::string version;  // CL_DEVICE_VERSION
    std::string driver;
    std::string platform;
    bool is_cpu = false;
    int vector_width = 1;  // floats of a CPU's vector register; on GPUs the built-in width of FV
    int lane_width = 1;    // floats that a kernel's FV holds: the built-in choice, or the caller's
    int compute_units = 1;
    int max_work_group = 1;         // work-items of a work-group
    std::uint64_t cache_bytes = 0;  // of the largest cache that global memory has; 0: unknown
    std::uint64_t memory_bytes = 0;
    std::uint64_t max_allocation_bytes = 0;

    bool is_pocl() const { return platform == "Portable Computing Language"; }
    bool is_oclgrind() const { return platform == "Oclgrind"; }
};

DeviceInfo describe(const cl::Device& device);

/// Every device of every platform; empty when there is none.
std::vector<cl::Device> all_devices();

/// The device meant by `choice`: an index into all_devices(), or a part of its name (any case);
/// empty: the first GPU, else the first device. Throws Error that lists what there is.
cl::Device choose_device(std::string_view choice);

class ProgramCache;

/// A device with its context and an in-order, profiling queue: what every stage is given.
/// Copies share the OpenCL objects and the programs built with them. `lane_width` 0: the device's.
struct Gpu {
    explicit Gpu(const cl::Device& device, int lane_width = 0);
    /// A caller's own context and queue. Throws Error unless the queue is in order and has
    /// profiling enabled.
    Gpu(cl::Context context, cl::CommandQueue queue, int lane_width = 0);

    /// A copy with kernels of `lane_width` lanes.
    Gpu with_lanes(int lane_width) const;

    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;
    DeviceInfo info;
    std::shared_ptr<ProgramCache> programs;
    std::shared_ptr<MemoryBudget> budget;  // bounds GrowingBuffers; null: only the device does
    bool checks_arguments = false;  // kernels compare their arguments by name and type: for tests
};

/// Opens choose_device(choice) and calls `then` with it, in a thread of its own; with a limited
/// address space in get(). get() throws what choose_device(), Gpu() and `then` throw. Environment
/// variables for PoCL are set before this function returns.
std::future<Gpu> open_gpu_async(std::string choice, std::function<void(const Gpu&)> then);

}  // namespace kilolux
