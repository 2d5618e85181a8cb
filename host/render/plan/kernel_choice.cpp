// SPDX-License-Identifier: Apache-2.0
#include "host/render/plan/kernel_choice.h"

#include "host/stages/lights/drift_lights.h"
#include "host/stages/lights/move_lights.h"
#include "host/stages/lights/prepare_lights.h"
#include "host/stages/lists/build_clusters.h"
#include "host/stages/lists/count_pairs.h"
#include "host/stages/surfaces/build_mips.h"

namespace kilolux {
namespace {

// Begins to build programs that depend on no scene and that most pictures need. The cache keeps
// them for the stages that are made later; a program that is not named here is built then.
void build_ahead(const Gpu& gpu, const Tuning& tuning) {
    DriftLights(gpu, tuning);
    MoveLights(gpu, tuning);
    BuildMips(gpu, tuning);
    PrepareLights(gpu, tuning);
    BuildClusters{gpu};
    CountPairs(gpu, tuning);
}

}  // namespace

StoredTuning choose_tuning(const DeviceInfo& device, const KernelSettings& settings) {
    StoredTuning choice = known_tuning(device);
    if (settings.lanes > 0) {
        choice.lanes = settings.lanes;
        choice.tuning = with_device_lanes(choice.tuning);
    }
    if (settings.group_height > 0) choice.tuning.shade_rows = settings.group_height;
    if (settings.chunks > 0) choice.tuning.cull_chunks = settings.chunks;
    return choice;
}

Gpu open_device(const RenderSettings& settings) {
    return device_for(settings,
                      settings.opened ? *settings.opened : Gpu(choose_device(settings.device)));
}

Gpu device_for(const RenderSettings& settings, const Gpu& opened) {
    Gpu gpu = opened;
    gpu.info = describe(gpu.device);  // KILOLUX_DEVICE_KIND may have changed
    gpu.info.lane_width = choose_tuning(gpu.info, settings.kernels).lanes;
    return gpu;
}

std::future<Gpu> open_device_async(const RenderSettings& settings) {
    return open_gpu_async(settings.device, [settings](const Gpu& opened) {
        // Oclgrind's compiler fails when several threads call it.
        if (!opened.info.is_oclgrind()) opened.programs->build_in_background();
        const Gpu gpu = device_for(settings, opened);
        build_ahead(gpu, choose_tuning(gpu.info, settings.kernels).tuning);
    });
}

}  // namespace kilolux
