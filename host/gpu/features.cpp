// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/features.h"

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

Tuning default_tuning(const DeviceInfo& device) {
    Tuning tuning;
    if (device.is_cpu) {
        // A tile's rows meet in the caches: a sixth less than row by row. With all 16 a thread's
        // share is too large to be even on many cores.
        tuning.shade_rows = 8;
        // With few lights pixels are waited for longer than they are shaded. Oclgrind and rusticl's
        // SPIR-V translator know no such instruction; the latter ends the process.
        tuning.shade_prefetch = device.platform == "Portable Computing Language" ? 1 : 0;
        tuning.cull_chunks = 16 * device.compute_units;
        tuning.light_group = 16;
        // Triangles are narrow: wider vectors are mostly empty. A tile of this size stays in the
        // nearest cache.
        tuning.raster_lanes = 8;
        tuning.raster_tile_width = 32;
        tuning.raster_tile_height = 32;
        return tuning;
    }
    tuning.shade_rows = 16;
    tuning.shade_stage = 128;
    tuning.cull_group = 64;
    tuning.cull_chunks = 16 * device.compute_units;
    tuning.refine_group = 64;
    tuning.prefix_group = 256;
    tuning.prefix_per_item = 8;
    tuning.tile_group = 64;
    tuning.light_group = 64;
    tuning.raster_group = 256;
    tuning.raster_tile_width = 32;
    tuning.raster_tile_height = 16;
    tuning.shadow_group = 64;
    return tuning;
}

}  // namespace kilolux
