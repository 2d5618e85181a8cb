// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "host/certify/synthetic/probe.h"
#include "host/gpu/device.h"
#include "host/gpu/features.h"
#include "tests/support/full.h"

namespace kilolux {

/// The device under test with kernels of `lane_width` lanes (0: the device's own).
/// KILOLUX_TEST_DEVICE chooses it as --device does; all lane widths share one context and queue.
Gpu test_gpu(int lane_width = 0);

/// What `run` makes with kernels of one lane. Expects the same of the other lane_widths().
template <typename Run>
auto at_every_width(const Run& run) {
    const auto out = run(test_gpu(1));
    for (const int lanes : lane_widths()) {
        EXPECT_EQ(lanes == 1 ? out : run(test_gpu(lanes)), out) << lanes << " lanes";
    }
    return out;
}

}  // namespace kilolux
