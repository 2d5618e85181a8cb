// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

/// Bytes of pixels' lists and of their stored surfaces.
double listed_surface_bytes(const StageCounts& counts);

/// The common part of stages that evaluate lights: build options, tables, lights in the kernels'
/// form, output.
class ShadingResources {
 public:
    ShadingResources(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                     std::string_view stage);

    /// With the lanes of shading.
    const Gpu& gpu() const { return gpu_; }
    BuildOptions options() const;
    WorkSize work_size(const Kernel& kernel, const View& view) const;

    /// The lights in the kernels' form: unchanged, or with colours in half precision.
    PreparedLights stored_lights(const PreparedLights& lights, StageTimer& timer);

    Radiance radiance(const View& view);

 private:
    Gpu gpu_;
    uint rows_;  // of a work-group
    Tuning tuning_;
    KernelFeatures features_;
    std::optional<Kernel> store_lights_;  // with half_light_colors
    GrowingArray<float> radiance_;
    GrowingArray<float4> stored_;
};

}  // namespace kilolux
