// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/roofline.h"

#include <algorithm>

#include "host/measure/roofline/stages.h"
#include "host/stages/shading/instruction_counts.h"
#include "kernels/shared/cluster_grid.h"

namespace kilolux {
namespace {

// Work that fits the cache moves at the cache's rates.
double bytes_seconds(const StageWork& work, const DeviceLimits& limits) {
    const double bytes = work.bytes();
    const bool cached = bytes <= limits.cache_bytes;
    const double read = cached ? limits.cached_read_bandwidth : limits.read_bandwidth;
    const double write = cached ? limits.cached_write_bandwidth : limits.write_bandwidth;
    const double copy = cached ? limits.cached_copy_bandwidth : limits.copy_bandwidth;
    const double mixed = bytes / std::max({read, write, copy});
    return std::max({work.bytes_read / read, work.bytes_written / write, mixed}) +
           work.bytes_uploaded / limits.upload_bandwidth;
}

double special_seconds(const InstructionCounts& counts, const DeviceLimits& limits) {
    return counts.rsqrts / limits.rsqrt_per_s + counts.sqrts / limits.sqrt_per_s +
           counts.divisions / limits.divisions_per_s;
}

}  // namespace

const char* bound_name(Bound bound) {
    constexpr const char* kNames[] = {"bytes", "instructions", "special functions", "texels",
                                      "launches"};
    return kNames[static_cast<std::size_t>(bound)];
}

StageLimit stage_limit(const StageWork& work, const DeviceLimits& limits) {
    const double launches = 1e-3 * limits.launch_event_ms * work.launches;
    const double bytes = bytes_seconds(work, limits);
    const double instructions = work.instructions.total / limits.lane_instructions_per_s;
    const double special = special_seconds(work.instructions, limits);
    const double texels = work.texels > 0.0 ? work.texels / limits.texels_per_s : 0.0;
    const double most = std::max({bytes, instructions, special, texels});
    StageLimit limit;
    limit.ms = 1e3 * (most + launches);
    if (launches < most) {
        limit.bound = most == bytes          ? Bound::bytes
                      : most == instructions ? Bound::instructions
                      : most == texels       ? Bound::texels
                                             : Bound::special_functions;
    }
    return limit;
}

FrameSetup frame_setup(const RenderSettings& settings, const ScenePlan& plan,
                       const DeviceInfo& device) {
    const bool ids = resolves_ids(settings.geometry) && !is_forward(settings.renderer);
    return {settings.width,
            settings.height,
            plan.kernels,
            plan.gbuffer_bytes_per_pixel,
            ids ? static_cast<int>(sizeof(uint)) : plan.gbuffer_bytes_per_pixel,
            settings.renderer,
            device.is_cpu};
}

StageCounts stage_counts(const FrameStats& stats, const FrameSetup& setup) {
    const auto number = [](auto value) { return static_cast<double>(value); };
    const auto tiles = [](int size) { return (size + FINE_TILE - 1) / FINE_TILE; };
    StageCounts c;
    c.pixels = number(setup.width) * setup.height;
    c.surface_pixels = stats.surface_pixels > 0 ? number(stats.surface_pixels) : c.pixels;
    c.directional_lights = number(stats.directional_lights);
    c.lights = number(stats.lights_used) - c.directional_lights;
    c.tiles = number(tiles(setup.width)) * tiles(setup.height);
    c.box_intervals = number(stats.grid[2]) * (number(stats.grid[0]) + stats.grid[1] + 1.0);
    c.clusters = number(stats.grid[0]) * stats.grid[1] * stats.grid[2];
    c.coarse_pairs = number(stats.coarse_pairs);
    c.active_clusters = number(stats.active_clusters);
    c.refine_tests = number(stats.refine_tests);
    c.triangles = number(stats.triangles);
    c.triangle_pairs = number(stats.triangle_pairs);
    c.seen_triangles = number(stats.seen_triangles);
    c.texels = number(stats.texels);
    c.refined_pairs = number(stats.refined_pairs);
    const bool all_lights = setup.renderer == RendererKind::deferred_all;
    c.evaluations = c.surface_pixels * (all_lights ? c.lights : stats.evaluations_per_pixel);
    // k* of them are in range at their pixel, and so are evaluated in full.
    const double in_range = std::max(stats.useful_evaluations_per_pixel, 0.0) * c.surface_pixels;
    c.full_evaluations =
        leaves_early(setup.kernels) ? std::min(in_range, c.evaluations) : c.evaluations;
    c.all_lights = all_lights;
    c.shaded_display = stats.shaded_display;
    c.shadow_rays = number(stats.shadows.rays);
    c.shadow_seen = number(stats.shadows.seen);
    c.shadow_words = number(stats.shadows.words);
    c.gbuffer_bytes_per_pixel = setup.gbuffer_bytes_per_pixel;
    c.bridge_bytes_per_pixel = setup.bridge_bytes_per_pixel;
    c.device_is_host = setup.device_is_host;
    c.kernels = setup.kernels;
    return c;
}

void fill_limits(FrameStats& stats, const DeviceLimits& limits, const FrameSetup& setup) {
    const StageCounts counts = stage_counts(stats, setup);
    for (StageTime& stage : stats.stages) {
        const StageInfo* info = stage_info(stage.name);
        stage.limit_ms = info && info->work ? stage_limit(info->work(counts), limits).ms : 0.0;
    }
}

}  // namespace kilolux
