// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>

#include "host/gpu/tuning/tuning_store.h"
#include "host/render/settings.h"

namespace kilolux {

/// How kernels are built and launched on a device: what `settings` asks for, else the best that is
/// known of the device (known_tuning).
StoredTuning choose_tuning(const DeviceInfo& device, const KernelSettings& settings);

/// The device of the settings with the lane width of choose_tuning().
Gpu open_device(const RenderSettings& settings);

/// The same of an open device.
Gpu device_for(const RenderSettings& settings, const Gpu& opened);

/// Opens the device of the settings in a thread of its own, and begins to build programs that do
/// not depend on the scene. See open_gpu_async().
std::future<Gpu> open_device_async(const RenderSettings& settings);

}  // namespace kilolux
