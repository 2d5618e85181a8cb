// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/limit_watch.h"

namespace kilolux {

LimitWatch::LimitWatch(const cl::Device& device)
    : gpu_(device, describe(device).vector_width),
      kernels_(gpu_),
      limits_(cached_device_limits(gpu_)) {
    const DeviceLimits before = limits_;
    settle_arithmetic_limits(limits_, kernels_);
    if (limits_ != before) keep_device_limits(gpu_.info, limits_);
}

void LimitWatch::look_again() {
    if (raise_arithmetic_limits(limits_, kernels_)) keep_device_limits(gpu_.info, limits_);
}

}  // namespace kilolux
