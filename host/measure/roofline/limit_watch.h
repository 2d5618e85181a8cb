// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/roofline/limit_kernels.h"

namespace kilolux {

/// A device's limits during a benchmark: those kept from before, measured again until they converge
/// and whenever the benchmark asks. Higher rates are kept for later runs, as other work on the
/// machine only makes a rate too low.
class LimitWatch {
 public:
    /// Takes up to three seconds, and one more where no limits are kept.
    explicit LimitWatch(const cl::Device& device);

    /// Measures the arithmetic once more, in 0.1 to 0.4 s.
    void look_again();

    const DeviceLimits& limits() const { return limits_; }

 private:
    Gpu gpu_;  // with the device's own lane width
    LimitKernels kernels_;
    DeviceLimits limits_;
};

}  // namespace kilolux
