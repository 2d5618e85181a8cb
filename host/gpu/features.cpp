// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/features.h"

#include <algorithm>
#include <bit>

#include "host/gpu/tuning/shipped_tunings.h"
#include "kernels/shared/cluster_grid.h"

namespace kilolux {

std::string_view light_index_type(const KernelFeatures& features) {
    return features.light_index_bits == 16 ? "ushort" : "uint";
}

std::size_t light_index_bytes(const KernelFeatures& features) {
    return static_cast<std::size_t>(features.light_index_bits / 8);
}

BuildOptions feature_options(const KernelFeatures& features) {
    BuildOptions options;
    options.define("SHADING", features.shading)
        .define("GBUFFER", static_cast<int>(features.gbuffer))
        .define("LIGHT_INDEX", light_index_type(features));
    for (const auto& [macro, value] : feature_macros(features)) options.define(macro, value);
    return options;
}

namespace {

constexpr int kLeastShared = 32;  // work-items that share a tile's triangles or shadows, if any do

}  // namespace

Tuning with_device_lanes(Tuning tuning) {
    tuning.pbr_lanes = 0;
    return tuning;
}

int fitting_group(int wanted, const DeviceInfo& device, int least) {
    const auto most = std::bit_floor(static_cast<unsigned>(std::max(device.max_work_group, 1)));
    const int group = std::min(wanted, static_cast<int>(most));
    return group >= least ? group : 1;
}

Tuning default_tuning(const DeviceInfo& device) {
    if (const auto forced = forced_tuning(device)) return forced->tuning;
    Tuning tuning;
    const int columns = std::max(FINE_TILE / device.lane_width, 1);
    if (device.is_cpu) {
        // Eight rows of a tile share cache lines: shading takes a sixth less than row by row. With
        // all 16 a thread's share is too coarse to balance on many cores.
        tuning.shade_rows = std::max(fitting_group(8 * columns, device) / columns, 1);
        // With few lights, loading pixels takes longer than shading them. Oclgrind and rusticl's
        // SPIR-V translator do not know the prefetch instruction; the latter ends the process.
        tuning.shade_prefetch = device.is_pocl() ? 1 : 0;
        tuning.cull_chunks = 16 * device.compute_units;
        tuning.light_group = fitting_group(16, device);
        // Triangles are narrow: wider vectors are mostly empty. A tile of this size stays in the
        // nearest cache.
        tuning.raster_lanes = 8;
        tuning.raster_tile_width = 32;
        tuning.raster_tile_height = 32;
        return tuning;
    }
    // Items that run in step wait for no other at barriers: 32 or 64, by vendor.
    tuning.shade_rows = std::clamp(fitting_group(64, device) / columns, 1, FINE_TILE);
    tuning.shade_stage = tuning.shade_rows > 1 ? 64 : 0;
    tuning.cull_group = fitting_group(64, device);
    tuning.cull_chunks = 16 * device.compute_units;
    tuning.refine_group = fitting_group(64, device);
    tuning.prefix_group = fitting_group(256, device);
    tuning.prefix_per_item = 8;
    tuning.tile_group = fitting_group(64, device);
    tuning.light_group = fitting_group(64, device);
    tuning.raster_group = fitting_group(256, device, kLeastShared);
    tuning.raster_tile_width = 32;
    tuning.raster_tile_height = 16;
    tuning.shadow_group = fitting_group(32, device, kLeastShared);
    return tuning;
}

}  // namespace kilolux
