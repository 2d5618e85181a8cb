// SPDX-License-Identifier: Apache-2.0
#include "host/stages/decode_gbuffer.h"

#include "host/base/srgb.h"
#include "kernels/shared/surface_planes.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "decode_gbuffer";

}  // namespace

DecodeGBuffer::DecodeGBuffer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      plane_count_(features.specular ? SURFACE_PLANES_WITH_SPECULAR : SURFACE_PLANES),
      program_(build_program(gpu, kStage, feature_options(features))),
      srgb_(gpu, kStage),
      planes_(gpu, kStage) {
    const auto table = srgb_to_linear_table();
    upload<float>(gpu_, srgb_.reserve(table.size() * sizeof(float)), table);
}

cl::Buffer DecodeGBuffer::enqueue(const GBuffer& gbuffer, StageTimer& timer) {
    return in_stage(kStage, [&] {
        const View& view = gbuffer.view;
        const cl::Buffer& planes =
            planes_.reserve(std::size_t{plane_count_} * sizeof(float) * view.stride * view.height);
        const auto items_per_tile = static_cast<std::size_t>(FINE_TILE / gpu_.info.lane_width);
        const auto rows = static_cast<std::size_t>(tuning_.shade_rows);
        const cl::NDRange items(view.stride / FINE_TILE * items_per_tile,
                                round_up(view.height, rows));
        cl::KernelFunctor<cl::Buffer, GBufferLayout, View, cl::Buffer, cl::Buffer> kernel(
            program_, "decode_gbuffer");
        timer.record(kStage,
                     kernel(cl::EnqueueArgs(gpu_.queue, items, cl::NDRange(items_per_tile, rows)),
                            gbuffer.bytes, gbuffer.layout, view, srgb_.get(), planes));
        return planes;
    });
}

}  // namespace kilolux
