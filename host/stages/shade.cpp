// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shade.h"

#include "host/base/srgb.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "shade";

BuildOptions options_of(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features) {
    return feature_options(features).define("STAGE", tuning.shade_stage).define("FAST_RSQRT", !gpu.info.is_cpu);
}

}  // namespace

Shade::Shade(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu), tuning_(tuning), features_(features), program_(build_program(gpu, kStage, options_of(gpu, tuning, features))),
      srgb_(gpu, kStage), radiance_(gpu, kStage), empty_(gpu, kStage) {
    const auto table = srgb_to_linear_table();
    upload<float>(gpu_, srgb_.reserve(table.size() * sizeof(float)), table);
    empty_.reserve(sizeof(ActiveCluster));
}

Radiance Shade::enqueue(const GBuffer& gbuffer, const PreparedLights& lights, const ClusterGrid& grid,
                        const ActiveClusters& clusters, const RefinedLists& lists, StageTimer& timer) {
    return launch(program_, gbuffer, lights, grid, clusters, lists, timer);
}

Radiance Shade::enqueue_all_lights(const GBuffer& gbuffer, const PreparedLights& lights, StageTimer& timer) {
    const cl::Program program = build_program(gpu_, kStage, options_of(gpu_, tuning_, features_).define("ALL_LIGHTS", 1));
    const ActiveClusters no_clusters{empty_.get(), empty_.get(), 0, 0};
    return launch(program, gbuffer, lights, ClusterGrid{}, no_clusters, RefinedLists{empty_.get(), 0}, timer);
}

Radiance Shade::launch(const cl::Program& program, const GBuffer& gbuffer, const PreparedLights& lights, const ClusterGrid& grid,
                       const ActiveClusters& clusters, const RefinedLists& lists, StageTimer& timer) {
    return in_stage(kStage, [&] {
        const View& view = gbuffer.view;
        Radiance out{radiance_.reserve(std::size_t{3} * sizeof(float) * view.stride * view.height), view};
        const auto items_per_tile = static_cast<std::size_t>(FINE_TILE / gpu_.info.lane_width);
        // Staging is a whole tile's common work.
        const auto rows = static_cast<std::size_t>(tuning_.shade_stage > 0 ? FINE_TILE : tuning_.shade_rows);
        const cl::NDRange items(view.stride / FINE_TILE * items_per_tile, round_up(view.height, rows));
        cl::KernelFunctor<cl::Buffer, GBufferLayout, View, cl::Buffer, cl::Buffer, uint, cl::Buffer, uint, ClusterGrid, cl::Buffer,
                          cl::Buffer, uint, cl::Buffer, float, cl::Buffer>
            kernel(program, "shade");
        timer.record(kStage, kernel(cl::EnqueueArgs(gpu_.queue, items, cl::NDRange(items_per_tile, rows)), gbuffer.bytes, gbuffer.layout,
                                    view, srgb_.get(), lights.directional, lights.directional_count, lights.lights, lights.count, grid,
                                    clusters.offsets, clusters.clusters, clusters.capacity, lists.lists, ambient_, out.planes));
        return out;
    });
}

}  // namespace kilolux
