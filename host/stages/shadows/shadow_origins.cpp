// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/shadow_origins.h"

namespace kilolux {

ShadowOrigins::ShadowOrigins(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      kernel_(gpu, build_program(gpu, kShadowOriginsStage, feature_options(features)),
              kShadowOriginsStage, "shadow_origins"),
      origins_(gpu, kShadowOriginsStage) {}

DeviceArray<float> ShadowOrigins::enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                                          const GBuffer& gbuffer, const ShadowCasters& casters,
                                          const ShadowView& shadow, StageTimer& timer) {
    const View& view = gbuffer.view;
    DeviceArray<float> out = origins_.reserve(kPlanes * std::size_t{view.stride} * view.height);
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, ids, gbuffer, shadow,
                    scene, casters.triangles, out);
    return out;
}

StageWork shadow_origins_work(const StageCounts& c) {
    return {.bytes_read = sizeof(uint) * c.pixels + sizeof(float) * c.surface_pixels,
            .bytes_written = kRowBytes * c.surface_pixels,
            .launches = 1};
}

}  // namespace kilolux
