// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/shadow_origins.h"

namespace kilolux {
namespace {

constexpr std::size_t kPlanes = 4;

}  // namespace

ShadowOrigins::ShadowOrigins(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu, build_program(gpu, kShadowOriginsStage, feature_options(features)),
              kShadowOriginsStage, "shadow_origins"),
      origins_(gpu, kShadowOriginsStage) {}

DeviceArray<float> ShadowOrigins::enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                                          const GBuffer& gbuffer, const ShadowCasters& casters,
                                          const ShadowView& shadow, StageTimer& timer) {
    const View& view = gbuffer.view;
    const DeviceArray<float> out =
        origins_.reserve(kPlanes * std::size_t{view.stride} * view.height);
    kernel_.enqueue(pixel_items(view, gpu_.info.lane_width, tuning_.shade_rows), timer, ids,
                    gbuffer.bytes, gbuffer.layout, view, shadow, scene.instances,
                    scene.instance_blocks, casters.triangles, out);
    return out;
}

StageWork shadow_origins_work(const StageCounts& c) {
    return {.bytes_read = sizeof(uint) * c.pixels + sizeof(float) * c.drawn_pixels,
            .bytes_written = kRowBytes * c.drawn_pixels,
            .launches = 1};
}

}  // namespace kilolux
