// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/roofline/device_limits.h"

namespace kilolux {

/// A measured limit and the same quantity by other means.
struct LimitCheck {
    std::string name;
    double measured = 0.0;     // by OpenCL
    double independent = 0.0;  // by C++ with intrinsics on CPUs; published peaks on GPUs

    double ratio() const { return independent > 0.0 ? measured / independent : 0.0; }
    /// Whether both agree within `factor`. A GPU stays below its published peak.
    bool agrees(double factor) const { return ratio() < factor && ratio() > 1.0 / factor; }
};

/// Quiet machines agree within a quarter; a count that is wrong by a factor of two does not pass.
inline constexpr double kLimitFactor = 1.6;

/// Checks multiply-adds and the bandwidths of reading and copying memory. Takes a second on CPUs.
/// Throws Error for a GPU whose published peaks are not known here.
std::vector<LimitCheck> check_limits(const DeviceInfo& device, const DeviceLimits& limits);

}  // namespace kilolux
