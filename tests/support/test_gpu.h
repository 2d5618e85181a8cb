// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/certify/synthetic/probe.h"
#include "host/gpu/device.h"
#include "host/gpu/features.h"

namespace kilolux {

/// The device under test with kernels of `lane_width` lanes (0: the device's own).
/// KILOLUX_TEST_DEVICE chooses it as --device does; all lane widths share one context and queue.
Gpu test_gpu(int lane_width = 0);

}  // namespace kilolux
