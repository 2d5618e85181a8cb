// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/decode_gbuffer.h"

#include "kernels/shared/gbuffer.h"

namespace kilolux {

DecodeGBuffer::DecodeGBuffer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      kernel_(gpu, build_program(gpu, kDecodeGbufferStage, feature_options(features)),
              kDecodeGbufferStage, "decode_gbuffer"),
      planes_(gpu, kDecodeGbufferStage) {}

DeviceArray<float> DecodeGBuffer::enqueue(const GBuffer& gbuffer, StageTimer& timer) {
    const View& view = gbuffer.view;
    auto planes = planes_.reserve(std::size_t{SURFACE_PLANES} * view.stride * view.height);
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, gbuffer, planes);
    return planes;
}

}  // namespace kilolux
