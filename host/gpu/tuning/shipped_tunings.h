// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "host/gpu/tuning/tuning_store.h"

namespace kilolux {

/// What `kilolux bench --tune` found on a device, as its certificate in host/certify/devices holds
/// it.
struct ShippedTuning {
    std::string_view platform, device, version;  // as DeviceInfo has them
    bool is_cpu = false;
    int compute_units = 1;
    StoredTuning tuning;
};

/// Those of all certificates; made of them by shipped_tunings.cmake.
std::span<const ShippedTuning> shipped_tunings();

/// A tuning found in a table, for the device at hand.
struct ShippedMatch {
    StoredTuning tuning;
    bool same_device = false;  // else only of its class
};

/// In this order: the row of the device's platform, name and kind; that of a GPU with the same
/// chip; one of its platform, on CPUs of the same OpenCL version, which names the instructions that
/// PoCL compiles for. The number of chunks of lights is scaled by compute units. A GPU of another
/// chip draws with OpenGL, as where nothing was measured: how fast OpenGL's way is depends on its
/// display. None: no row matches.
std::optional<ShippedMatch> shipped_tuning(const DeviceInfo& device,
                                           std::span<const ShippedTuning> table);

/// For tests, which run with each on whatever machine: KILOLUX_SHIPPED_TUNING=<a part of a device's
/// name> takes the tuning that is shipped for it, also for default_tuning(), as far as the device
/// is of the same kind and accepts it. Throws Error for a name that none has.
std::optional<StoredTuning> forced_tuning(const DeviceInfo& device);

}  // namespace kilolux
