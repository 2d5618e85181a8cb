// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace kilolux
