// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {

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
