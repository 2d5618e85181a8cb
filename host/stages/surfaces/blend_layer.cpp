// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/blend_layer.h"

namespace kilolux {
namespace {

BuildOptions blend_options(const Tuning& tuning, const SurfaceFeatures& features) {
    BuildOptions options;
    define_surfaces(options, alpha_features(features), tuning);
    return options;
}

}  // namespace

BlendLayer::BlendLayer(const Gpu& gpu, const Tuning& tuning, const SurfaceFeatures& features)
    : tuning_(tuning),
      kernel_(gpu, build_program(gpu, kBlendLayerStage, blend_options(tuning, features)),
              kBlendLayerStage, "blend_layer") {}

void BlendLayer::enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                         const Radiance& layer, const Radiance& behind, StageTimer& timer) {
    kernel_.enqueue(kernel_.pixel_items(layer.view, tuning_.shade_rows), timer, layer.view, scene,
                    ids, layer.planes, behind.planes);
}

}  // namespace kilolux
