// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/decode_gbuffer.h"

#include "kernels/shared/surface_planes.h"

namespace kilolux {

DecodeGBuffer::DecodeGBuffer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      plane_count_(features.specular ? SURFACE_PLANES_WITH_SPECULAR : SURFACE_PLANES),
      kernel_(gpu, build_program(gpu, kDecodeGbufferStage, feature_options(features)),
              kDecodeGbufferStage, "decode_gbuffer"),
      planes_(gpu, kDecodeGbufferStage) {}

DeviceArray<float> DecodeGBuffer::enqueue(const GBuffer& gbuffer, StageTimer& timer) {
    const View& view = gbuffer.view;
    auto planes = planes_.reserve(std::size_t{plane_count_} * view.stride * view.height);
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, gbuffer, planes);
    return planes;
}

}  // namespace kilolux
