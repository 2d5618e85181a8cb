// SPDX-License-Identifier: Apache-2.0
#include "host/stages/count_lights.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "count_lights";

}  // namespace

CountLights::CountLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kStage, feature_options(features))),
      evaluated_(gpu, kStage),
      covering_(gpu, kStage) {}

LightCounts CountLights::enqueue(const GBuffer& gbuffer, const PreparedLights& lights,
                                 const ClusterGrid& grid, const ActiveClusters& clusters,
                                 const RefinedLists& lists, StageTimer& timer) {
    return in_stage(kStage, [&] {
        const View& view = gbuffer.view;
        const std::size_t bytes = std::size_t{view.stride} * view.height * sizeof(uint);
        LightCounts out{evaluated_.reserve(bytes), covering_.reserve(bytes)};
        const auto items_per_tile = static_cast<std::size_t>(FINE_TILE / gpu_.info.lane_width);
        const auto rows = static_cast<std::size_t>(tuning_.shade_rows);
        const cl::NDRange items(view.stride / FINE_TILE * items_per_tile,
                                round_up(view.height, rows));
        cl::KernelFunctor<cl::Buffer, GBufferLayout, View, cl::Buffer, ClusterGrid, cl::Buffer,
                          cl::Buffer, uint, cl::Buffer, cl::Buffer, cl::Buffer>
            kernel(program_, "count_lights");
        timer.record(
            kStage,
            kernel(cl::EnqueueArgs(gpu_.queue, items, cl::NDRange(items_per_tile, rows)),
                   gbuffer.bytes, gbuffer.layout, view, lights.bounds, grid, clusters.offsets,
                   clusters.clusters, clusters.capacity, lists.lists, out.evaluated, out.covering));
        return out;
    });
}

}  // namespace kilolux
