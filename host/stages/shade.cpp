// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shade.h"

#include "host/base/srgb.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "shade";

BuildOptions options_of(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features) {
    BuildOptions options = feature_options(features)
                               .define("STAGE", tuning.shade_stage)
                               .define("PREFETCH", tuning.shade_prefetch)
                               .define("FAST_RSQRT", !gpu.info.is_cpu);
    if (features.fast_relaxed_math) options.flag("-cl-fast-relaxed-math");
    if (features.native_math) options.define("NATIVE_MATH", 1);
    if (features.half_light_colors) options.define("HALF_LIGHT_COLORS", 1);
    return options;
}

// PoCL 3.1 loses values across the barriers of staged work-groups one item wide, which 16 lanes
// make, and reads through a wild pointer (hard case 17). A CPU has no local memory to gain by
// staging anyway.
Tuning usable(Tuning tuning, const DeviceInfo& device) {
    if (device.is_cpu && device.lane_width >= FINE_TILE) tuning.shade_stage = 0;
    return tuning;
}

// Of kernels/shade.cl's StoredLight.
constexpr std::size_t kStoredLightRows = 2;

}  // namespace

Shade::Shade(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(usable(tuning, gpu.info)),
      features_(features),
      program_(build_program(gpu, kStage, options_of(gpu, tuning_, features))),
      srgb_(gpu, kStage),
      radiance_(gpu, kStage),
      empty_(gpu, kStage),
      stored_(gpu, kStage) {
    const auto table = srgb_to_linear_table();
    upload<float>(gpu_, srgb_.reserve(table.size() * sizeof(float)), table);
    empty_.reserve(sizeof(ActiveCluster));
}

Radiance Shade::enqueue(const GBuffer& gbuffer, const PreparedLights& lights,
                        const ClusterGrid& grid, const ActiveClusters& clusters,
                        const RefinedLists& lists, StageTimer& timer) {
    return launch(program_, gbuffer, lights, grid, clusters, lists, timer);
}

Radiance Shade::enqueue_all_lights(const GBuffer& gbuffer, const PreparedLights& lights,
                                   StageTimer& timer) {
    const cl::Program program =
        build_program(gpu_, kStage, options_of(gpu_, tuning_, features_).define("ALL_LIGHTS", 1));
    const ActiveClusters no_clusters{empty_.get(), empty_.get(), 0, 0, empty_.get(), empty_.get()};
    return launch(program, gbuffer, lights, ClusterGrid{}, no_clusters,
                  RefinedLists{empty_.get(), 0}, timer);
}

// The lights as the kernel reads them: as they are, or stored anew with colours in half precision.
cl::Buffer Shade::stored_lights(const cl::Program& program, const PreparedLights& lights,
                                StageTimer& timer) {
    if (!features_.half_light_colors || lights.count == 0) return lights.lights;
    const std::size_t rows = kStoredLightRows + (features_.spot_lights ? 1 : 0);
    cl::Buffer stored = stored_.reserve(lights.count * rows * sizeof(float4));
    cl::KernelFunctor<cl::Buffer, cl::Buffer> kernel(program, "store_lights");
    timer.record(kStage, kernel(cl::EnqueueArgs(gpu_.queue, cl::NDRange(lights.count)),
                                lights.lights, stored));
    return stored;
}

Radiance Shade::launch(const cl::Program& program, const GBuffer& gbuffer,
                       const PreparedLights& lights, const ClusterGrid& grid,
                       const ActiveClusters& clusters, const RefinedLists& lists,
                       StageTimer& timer) {
    return in_stage(kStage, [&] {
        const View& view = gbuffer.view;
        Radiance out{radiance_.reserve(std::size_t{3} * sizeof(float) * view.stride * view.height),
                     view};
        const cl::Buffer stored = stored_lights(program, lights, timer);
        const auto items_per_tile = static_cast<std::size_t>(FINE_TILE / gpu_.info.lane_width);
        // Staging is a whole tile's common work.
        const auto rows =
            static_cast<std::size_t>(tuning_.shade_stage > 0 ? FINE_TILE : tuning_.shade_rows);
        const cl::NDRange items(view.stride / FINE_TILE * items_per_tile,
                                round_up(view.height, rows));
        cl::KernelFunctor<cl::Buffer, GBufferLayout, View, cl::Buffer, cl::Buffer, uint, cl::Buffer,
                          uint, ClusterGrid, cl::Buffer, cl::Buffer, uint, cl::Buffer, cl::Buffer,
                          float, cl::Buffer>
            kernel(program, "shade");
        timer.record(kStage,
                     kernel(cl::EnqueueArgs(gpu_.queue, items, cl::NDRange(items_per_tile, rows)),
                            gbuffer.bytes, gbuffer.layout, view, srgb_.get(), lights.directional,
                            lights.directional_count, stored, lights.count, grid, clusters.offsets,
                            clusters.clusters, clusters.capacity, clusters.order, lists.lists,
                            ambient_, out.planes));
        return out;
    });
}

}  // namespace kilolux
