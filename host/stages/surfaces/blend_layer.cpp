// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/blend_layer.h"

namespace kilolux {
namespace {

BuildOptions blend_options(const Tuning& tuning, const KernelFeatures& features,
                           const SurfaceFeatures& surfaces) {
    BuildOptions options = feature_options(features);
    define_surfaces(options, alpha_features(surfaces), tuning);
    return options;
}

}  // namespace

BlendLayer::BlendLayer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                       const SurfaceFeatures& surfaces)
    : tuning_(tuning),
      kernel_(gpu, build_program(gpu, kBlendLayerStage, blend_options(tuning, features, surfaces)),
              kBlendLayerStage, "blend_layer") {}

void BlendLayer::enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                         const GBuffer& surfaces, const Radiance& lit, const Radiance& behind,
                         StageTimer& timer) {
    const View one = first_layers(surfaces.view, 1);
    kernel_.enqueue(kernel_.pixel_items(one, tuning_.shade_rows), timer, surfaces, scene, ids,
                    lit.planes, behind.view, behind.planes);
}

}  // namespace kilolux
