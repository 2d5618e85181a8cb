// SPDX-License-Identifier: Apache-2.0
#include "host/render/kernel_choice.h"

namespace kilolux {

StoredTuning choose_tuning(const DeviceInfo& device, const KernelSettings& settings) {
    StoredTuning choice = known_tuning(device);
    if (settings.lanes > 0) choice.lanes = settings.lanes;
    if (settings.group_height > 0) choice.tuning.shade_rows = settings.group_height;
    if (settings.chunks > 0) choice.tuning.cull_chunks = settings.chunks;
    return choice;
}

Gpu open_device(const RenderSettings& settings) {
    const cl::Device device = choose_device(settings.device);
    return Gpu(device, choose_tuning(describe(device), settings.kernels).lanes);
}

}  // namespace kilolux
