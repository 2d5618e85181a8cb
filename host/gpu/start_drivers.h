// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

namespace kilolux {

/// Starts the OpenCL drivers in a thread of their own, while a scene is loaded: NVIDIA's take 0.4
/// s. Otherwise the first call of all_devices() starts them.
std::jthread start_drivers();

}  // namespace kilolux
