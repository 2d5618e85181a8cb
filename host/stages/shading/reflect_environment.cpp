// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shading/reflect_environment.h"

#include "host/base/srgb.h"
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
      srgb_(gpu, kReflectEnvironmentStage),
      texels_(gpu, kReflectEnvironmentStage),
      table_(gpu, kReflectEnvironmentStage),
      levels_(gpu, kReflectEnvironmentStage) {
    const auto table = srgb_to_linear_table();
    upload<float>(gpu_, srgb_.reserve(table.size()), table);
}

void ReflectEnvironment::set_maps(const ReflectionMapsView& maps) {
    upload<float>(gpu_, texels_.reserve(maps.texels.size()), maps.texels);
    upload<uint4>(gpu_, levels_.reserve(maps.levels.size()), maps.levels);
    upload<float>(gpu_, table_.reserve(maps.table.size()), maps.table);
    roughness_levels_ = static_cast<uint>(maps.levels.size()) - 1;
    table_size_ = maps.table_size;
}

void ReflectEnvironment::enqueue(const GBuffer& gbuffer, const Radiance& radiance,
                                 StageTimer& timer) {
    const View& view = gbuffer.view;
    kernel_.enqueue(pixel_items(view, gpu_.info.lane_width, tuning_.shade_rows), timer,
                    gbuffer.bytes, gbuffer.layout, view, srgb_.get(), texels_.get(), levels_.get(),
                    roughness_levels_, table_.get(), table_size_, radiance.planes);
}

}  // namespace kilolux
