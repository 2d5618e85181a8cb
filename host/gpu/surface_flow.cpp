// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/surface_flow.h"

namespace kilolux {

void define_surfaces(BuildOptions& options, const SurfaceFeatures& surfaces, const Tuning& tuning) {
    for (const auto& [macro, value] : surface_macros(surfaces)) options.define(macro, value);
    options.define("PREFETCH", tuning.shade_prefetch);
}

void define_casters(BuildOptions& options, const SurfaceFeatures& surfaces, const Tuning& tuning) {
    define_surfaces(options, surfaces, tuning);
    options.define("HAS_MASKED_CASTERS", surfaces.masks);
}

void define_tiles(BuildOptions& options, const Tuning& tuning) {
    options.define("TILE_WIDTH", tuning.raster_tile_width)
        .define("TILE_HEIGHT", tuning.raster_tile_height);
}

uint raster_tile_count(const View& view, const Tuning& tuning) {
    const auto width = static_cast<uint>(tuning.raster_tile_width);
    const auto height = static_cast<uint>(tuning.raster_tile_height);
    return (view.width + width - 1) / width * ((view.height + height - 1) / height);
}

}  // namespace kilolux
