// SPDX-License-Identifier: Apache-2.0
#include "present/cli/device_list.h"

#include <fmt/format.h>

#include <cstddef>

namespace kilolux {

std::string device_list(const std::vector<DeviceInfo>& devices) {
    if (devices.empty()) return "no OpenCL devices\n";
    std::string out;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo& d = devices[i];
        out += fmt::format("{}  {} ({}, {} compute units, {} lanes, {} MiB; {}; driver {}; {})\n",
                           i, d.name, d.is_cpu ? "CPU" : "GPU", d.compute_units, d.lane_width,
                           d.memory_bytes >> 20, d.version, d.driver, d.platform);
    }
    return out;
}

nlohmann::ordered_json device_json(const DeviceInfo& device) {
    return {{"name", device.name},
            {"version", device.version},
            {"driver", device.driver},
            {"platform", device.platform},
            {"cpu", device.is_cpu},
            {"lane_width", device.lane_width},
            {"compute_units", device.compute_units},
            {"memory_bytes", device.memory_bytes},
            {"max_allocation_bytes", device.max_allocation_bytes}};
}

}  // namespace kilolux
