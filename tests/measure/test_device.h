// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/gpu/tuning/tuning_store.h"

namespace kilolux {

/// A CPU with two cores and 8 lanes that no table of tunings has.
inline DeviceInfo device_named(const std::string& name) {
    DeviceInfo device;
    device.name = name;
    device.version = "OpenCL 3.0";
    device.driver = "1.2.3";
    device.platform = "Test";
    device.is_cpu = true;
    device.lane_width = 8;
    device.compute_units = 2;
    device.max_work_group = 4096;
    return device;
}

/// A tuning that device_named() accepts, and not the built-in one.
inline StoredTuning some_tuning() {
    StoredTuning stored{4, {}};
    stored.tuning.shade_rows = 8;
    stored.tuning.cull_chunks = 24;
    stored.tuning.light_group = 64;
    return stored;
}

}  // namespace kilolux
