// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_gpu.h"

#include <cstdlib>

namespace kilolux {
namespace {

Gpu first_gpu() {
    const char* choice = std::getenv("KILOLUX_TEST_DEVICE");
    Gpu gpu(choose_device(choice != nullptr ? choice : ""));
    gpu.checks_arguments = true;
    return gpu;
}

}  // namespace

Gpu test_gpu(int lane_width) {
    static const Gpu gpu = first_gpu();
    return gpu.with_lanes(lane_width);
}

}  // namespace kilolux
