// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/roofline/device_limits.h"
#include "host/measure/roofline/limit_kernels.h"

namespace kilolux {

/// A device's limits while a benchmark runs: those of the cache, measured again until they settle,
/// and again whenever the benchmark says so. What rises is kept in the cache: the best that was
/// ever seen counts, since other work on the machine only makes a rate too low, and a ratio to it
/// too good.
class LimitWatch {
 public:
    /// Takes up to three seconds; a second more where nothing is kept yet.
    explicit LimitWatch(const cl::Device& device);

    /// Measures the arithmetic once more; a tenth of a second or two.
    void look_again();

    const DeviceLimits& limits() const { return limits_; }

 private:
    Gpu gpu_;  // of the device's own lane width
    LimitKernels kernels_;
    DeviceLimits limits_;
};

}  // namespace kilolux
