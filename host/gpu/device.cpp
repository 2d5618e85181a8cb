// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/device.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "host/base/error.h"
#include "host/base/system/memory.h"
#include "host/base/text.h"
#include "host/gpu/pocl_cache.h"
#include "host/gpu/program.h"

namespace kilolux {
namespace {

// Some drivers count the terminating zero.
std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return text;
}

// Two pixels a work-item on GPUs: more share the loads of a light, but lists then make work-items
// wait for each other (NVIDIA H200, Sponza, 5000 lights, against four: lambert 1.25, pbr 1.4 times
// as fast).
constexpr int kGpuLanes = 2;

// Two vector registers a work-item on CPUs: their chains of operations hide each other's latency
// (AVX2, shade, against one: lambert 1.1, pbr 1.2, blinn-phong 1.4 times as fast).
void set_lanes(DeviceInfo& info, const cl::Device& device) {
    const auto width = static_cast<int>(device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>());
    info.vector_width = info.is_cpu ? std::clamp(width, 1, 16) : kGpuLanes;
    info.lane_width = info.is_cpu ? std::min(2 * info.vector_width, 16) : kGpuLanes;
}

void check_queue(const cl::CommandQueue& queue, const std::string& device) {
    const auto properties = queue.getInfo<CL_QUEUE_PROPERTIES>();
    const char* wrong = (properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0
                            ? "runs out of order"
                        : (properties & CL_QUEUE_PROFILING_ENABLE) == 0 ? "has no profiling enabled"
                                                                        : nullptr;
    if (wrong != nullptr) {
        throw Error("OpenCL: " + device + ": the given queue " + wrong +
                    "; it must be in order, with CL_QUEUE_PROFILING_ENABLE");
    }
}

std::string list_of(const std::vector<cl::Device>& devices) {
    std::string list;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        list += (i ? ", " : "") + std::to_string(i) + ": " +
                trimmed(devices[i].getInfo<CL_DEVICE_NAME>());
    }
    return list;
}

bool is_gpu(const cl::Device& device) {
    return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
}

// True for the host's own processor. Tests set KILOLUX_DEVICE_KIND=gpu to treat it as a device that
// has its own memory.
bool shares_host_memory(const cl::Device& device) {
    const char* kind = std::getenv("KILOLUX_DEVICE_KIND");
    if (kind != nullptr && std::string_view(kind) == "gpu") return false;
    return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
}

// A forked child has none of the driver's threads.
void refuse_after_fork() {
    static const pid_t first = ::getpid();
    if (::getpid() == first) return;
    throw Error(
        "OpenCL: this process was forked from one that used OpenCL; start it anew (Python: "
        "multiprocessing's start method 'spawn')");
}

}  // namespace

DeviceInfo describe(const cl::Device& device) {
    DeviceInfo info;
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.platform =
        trimmed(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>());
    info.is_cpu = shares_host_memory(device);
    set_lanes(info, device);
    info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    info.max_work_group = static_cast<int>(
        std::min<std::size_t>(device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(), 65536));
    info.cache_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
    info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    return info;
}

std::vector<cl::Device> all_devices() {
    refuse_after_fork();
    prepare_pocl();
    // Drivers start here. To a second thread PoCL 3.1 says meanwhile that it has no device.
    static std::mutex starting;
    const std::scoped_lock lock(starting);
    static bool started = false;
    // PoCL 3.1 with LLVM 14 takes 412 MiB to build the programs of a picture. With less it crashes,
    // or waits for ever for a lock that a failed build has left.
    constexpr std::uint64_t kAddressSpace = std::uint64_t{576} << 20;
    if (!started) require_address_space(kAddressSpace, "OpenCL's driver");
    started = true;
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        return {};  // the loader reports "no platform" as an error
    }
    std::vector<cl::Device> all;
    for (const cl::Platform& platform : platforms) {
        std::vector<cl::Device> devices;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error&) {
            continue;  // a platform without devices
        }
        all.insert(all.end(), devices.begin(), devices.end());
    }
    return all;
}

namespace {

cl::Device device_of(std::string_view choice) {
    const std::vector<cl::Device> devices = all_devices();
    if (devices.empty()) {
        const std::string& missing = prepare_pocl();
        throw Error("OpenCL: no device found; " +
                    (missing.empty() ? "install a driver, e.g. the package pocl-opencl-icd (OpenCL "
                                       "on the CPU)"
                                     : missing));
    }
    if (choice.empty()) {
        const auto gpu = std::find_if(devices.begin(), devices.end(), is_gpu);
        return gpu != devices.end() ? *gpu : devices.front();
    }
    // A whole number is an index and no part of a name.
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
    const bool is_index = end == choice.data() + choice.size();
    if (is_index && error == std::errc() && index < devices.size()) return devices[index];
    for (const cl::Device& device : devices) {
        const std::string name = lower(device.getInfo<CL_DEVICE_NAME>());
        if (!is_index && name.find(lower(choice)) != std::string::npos) return device;
    }
    throw Error("OpenCL: no device '" + std::string(choice) +
                "'; the devices are, by index: " + list_of(devices));
}

}  // namespace

cl::Device choose_device(std::string_view choice) {
    cl::Device device = device_of(choice);
    const std::string& missing = prepare_pocl();
    if (!missing.empty() && describe(device).is_pocl()) {
        throw Error("OpenCL: " + describe(device).name + ": " + missing);
    }
    return device;
}

Gpu::Gpu(const cl::Device& chosen, int lane_width)
    : device(chosen), programs(std::make_shared<ProgramCache>()) {
    try {
        context = cl::Context(device);
        queue = cl::CommandQueue(context, device, cl::QueueProperties::Profiling);
    } catch (const cl::Error& error) {
        throw Error("OpenCL: " + trimmed(device.getInfo<CL_DEVICE_NAME>()) + ": " + error.what() +
                    " failed with " + cl_error_name(error.err()));
    }
    info = describe(device);
    if (lane_width > 0) info.lane_width = lane_width;
}

std::future<Gpu> open_gpu_async(std::string choice, std::function<void(const Gpu&)> then) {
    prepare_pocl();
    // Drivers and the caller would each find room that the other takes.
    const bool waits = has_address_space_limit();
    return std::async(waits ? std::launch::deferred : std::launch::async,
                      [device = std::move(choice), then = std::move(then)] {
                          Gpu gpu(choose_device(device));
                          then(gpu);
                          return gpu;
                      });
}

Gpu::Gpu(cl::Context existing_context, cl::CommandQueue existing_queue, int lane_width)
    : device(existing_queue.getInfo<CL_QUEUE_DEVICE>()),
      context(std::move(existing_context)),
      queue(std::move(existing_queue)),
      info(describe(device)),
      programs(std::make_shared<ProgramCache>()) {
    check_queue(queue, info.name);
    if (lane_width > 0) info.lane_width = lane_width;
}

Gpu Gpu::with_lanes(int lane_width) const {
    Gpu copy = *this;
    copy.info.lane_width = lane_width > 0 ? lane_width : describe(device).lane_width;
    return copy;
}

}  // namespace kilolux
