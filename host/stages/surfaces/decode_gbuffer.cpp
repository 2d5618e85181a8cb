// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/decode_gbuffer.h"

#include "host/base/srgb.h"
#include "kernels/shared/surface_planes.h"

namespace kilolux {
namespace {

constexpr std::string_view kDecodeGbufferStage = "decode_gbuffer";

}  // namespace

DecodeGBuffer::DecodeGBuffer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      plane_count_(features.specular ? SURFACE_PLANES_WITH_SPECULAR : SURFACE_PLANES),
      kernel_(gpu, build_program(gpu, kDecodeGbufferStage, feature_options(features)),
              kDecodeGbufferStage, "decode_gbuffer"),
      srgb_(gpu, kDecodeGbufferStage),
      planes_(gpu, kDecodeGbufferStage) {
    const auto table = srgb_to_linear_table();
    upload<float>(gpu_, srgb_.reserve(table.size()), table);
}

DeviceArray<float> DecodeGBuffer::enqueue(const GBuffer& gbuffer, StageTimer& timer) {
    const View& view = gbuffer.view;
    const auto planes = planes_.reserve(std::size_t{plane_count_} * view.stride * view.height);
    kernel_.enqueue(pixel_items(view, gpu_.info.lane_width, tuning_.shade_rows), timer,
                    gbuffer.bytes, gbuffer.layout, view, srgb_.get(), planes);
    return planes;
}

}  // namespace kilolux
