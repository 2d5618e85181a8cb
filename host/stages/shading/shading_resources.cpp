// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shading/shading_resources.h"

#include <algorithm>
#include <bit>

#include "kernels/shared/cluster_grid.h"

namespace kilolux {
namespace {

// The device with the lanes of shading.
Gpu shading_device(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features) {
    const Tuning t = features.sampled_shadows ? with_device_lanes(tuning) : tuning;
    return features.shading == SHADING_PBR && t.pbr_lanes > 0 ? gpu.with_lanes(t.pbr_lanes) : gpu;
}

// Fewer lanes have fewer rows, so that a work-group keeps its number of work-items. Its rows lie
// within a tile.
uint rows_of_group(const Gpu& device, const Gpu& shading, int rows) {
    const int wanted = rows * shading.info.lane_width / device.info.lane_width;
    return std::bit_floor(static_cast<uint>(std::clamp(wanted, 1, FINE_TILE)));
}

// PoCL 3.1 loses values across the barriers of staged work-groups one item wide, which 16 lanes
// make or a device without groups, and reads through a wild pointer (hard case 17). A CPU gains
// nothing by staging, and GPUs are not built with that many lanes.
Tuning usable_for_shading(Tuning tuning, const DeviceInfo& device) {
    if (device.lane_width >= FINE_TILE || device.max_work_group == 1) tuning.shade_stage = 0;
    return tuning;
}

// float4 rows of a StoredLight of kernels/device/stored_light.h.
std::size_t stored_light_rows(const KernelFeatures& features) {
    std::size_t rows = 2;
#define COUNT_STORED_ROW(has, feature, member) rows += features.feature ? 1 : 0;
    LIGHT_ROWS(COUNT_STORED_ROW)
    return rows;
}

}  // namespace

double listed_surface_bytes(const StageCounts& c) {
    return (c.gbuffer_bytes_per_pixel + kPixelOrderBytes) * c.surface_pixels +
           sizeof(ActiveCluster) * c.active_clusters + c.index_bytes() * c.refined_pairs;
}

ShadingResources::ShadingResources(const Gpu& gpu, const Tuning& tuning,
                                   const KernelFeatures& features, std::string_view stage)
    : gpu_(shading_device(gpu, tuning, features)),
      rows_(rows_of_group(gpu, gpu_, tuning.shade_rows)),
      tuning_(usable_for_shading(tuning, gpu_.info)),
      features_(features),
      radiance_(gpu, stage),
      stored_(gpu, stage) {
    if (features.half_light_colors) {
        store_lights_.emplace(gpu_, build_program(gpu_, "store_lights", options()), stage,
                              "store_lights");
    }
}

BuildOptions ShadingResources::options() const {
    BuildOptions options = feature_options(features_)
                               .define("STAGE", tuning_.shade_stage)
                               .define("PREFETCH", tuning_.shade_prefetch)
                               .define("FAST_RSQRT", !gpu_.info.is_cpu)
                               .define("NATIVE_MATH", features_.native_math)
                               .define("HALF_LIGHT_COLORS", features_.half_light_colors);
    if (features_.fast_relaxed_math) options.flag("-cl-fast-relaxed-math");
    return options;
}

WorkSize ShadingResources::work_size(const Kernel& kernel, const View& view) const {
    return kernel.pixel_items(view, static_cast<int>(rows_));
}

PreparedLights ShadingResources::stored_lights(const PreparedLights& lights, StageTimer& timer) {
    if (!store_lights_ || lights.rows() == 0) return lights;
    const DeviceArray<float4> stored =
        stored_.reserve(lights.rows() * stored_light_rows(features_));
    store_lights_->enqueue({cl::NDRange(lights.rows()), cl::NullRange}, timer, lights.lights,
                           stored);
    PreparedLights out = lights;
    out.lights = DeviceArray<ShadeLight>(stored.buffer(), lights.rows());
    return out;
}

Radiance ShadingResources::radiance(const View& view) {
    Radiance out{{}, view, static_cast<uint>(features_.light_groups)};
    out.planes = radiance_.reserve(out.floats());
    return out;
}

}  // namespace kilolux
