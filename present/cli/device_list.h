// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/gpu/device.h"

namespace kilolux {

/// A line a device, with the index that --device takes.
std::string device_list(const std::vector<DeviceInfo>& devices);

nlohmann::ordered_json device_json(const DeviceInfo& device);

}  // namespace kilolux
