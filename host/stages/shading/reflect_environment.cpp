// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shading/reflect_environment.h"

#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

// Blinn and Phong's lobe is reflected as the pbr one of its roughness.
KernelFeatures reflecting(KernelFeatures features) {
    if (features.shading == SHADING_BLINN_PHONG) features.shading = SHADING_PBR;
    return features;
}

}  // namespace

ReflectEnvironment::ReflectEnvironment(const Gpu& gpu, const Tuning& tuning,
                                       const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu,
              build_program(gpu, kReflectEnvironmentStage, feature_options(reflecting(features))),
              kReflectEnvironmentStage, "reflect_environment"),
      texels_(gpu, kReflectEnvironmentStage),
      table_(gpu, kReflectEnvironmentStage),
      levels_(gpu, kReflectEnvironmentStage) {}

void ReflectEnvironment::set_maps(const ReflectionMapsView& maps) {
    upload<float>(gpu_, texels_.reserve(maps.texels.size()), maps.texels);
    upload<uint4>(gpu_, levels_.reserve(maps.levels.size()), maps.levels);
    upload<float>(gpu_, table_.reserve(maps.table.size()), maps.table);
    maps_ = {texels_.get(), levels_.get(), static_cast<uint>(maps.levels.size()) - 1, table_.get(),
             maps.table_size};
}

void ReflectEnvironment::enqueue(const GBuffer& gbuffer, const Radiance& radiance,
                                 StageTimer& timer) {
    const View& view = gbuffer.view;
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, gbuffer, maps_,
                    radiance.planes);
}

}  // namespace kilolux
