// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/generated/bake.h"

namespace kilolux {

// The surfaces of the atrium. All tile; `seed` changes veins, stains and stones, not sizes.

/// Running bond: 1.6 m of 8 bricks by 20 courses, with normal map and roughness.
SurfaceImages brick_images(std::uint32_t seed);
/// Octagons and dots of marble: 1.6 m of 4 by 4 tiles, with normal map and roughness.
SurfaceImages tile_images(std::uint32_t seed);
/// Flagstones of uneven width in even courses: 3.2 m, with normal map and roughness.
SurfaceImages paving_images(std::uint32_t seed);
/// Wedges of an arch by turns red and pale along u: 2 m of 8 wedges.
SurfaceImages voussoir_images(std::uint32_t seed);
/// Small glass tiles, blue waves on white: 0.8 m of 40 by 40.
SurfaceImages mosaic_images(std::uint32_t seed);

/// White marble with grey veins: 2 m.
SurfaceImages marble_images(std::uint32_t seed);
/// Warm fine-grained stone: 2 m.
SurfaceImages limestone_images(std::uint32_t seed);
/// Ochre plaster with stains, with normal map: 3.2 m.
SurfaceImages plaster_images(std::uint32_t seed);
/// Planks along u: 1.6 m of 6, with normal map.
SurfaceImages wood_images(std::uint32_t seed);
/// Fired clay of roof and pots: 0.8 m.
SurfaceImages terracotta_images(std::uint32_t seed);
/// Pale damask, to be tinted: 0.8 m.
SurfaceImages cloth_images(std::uint32_t seed);
/// Mottled green: 0.2 m.
SurfaceImages leaf_images(std::uint32_t seed);
/// Ripples: 2 m, a normal map only.
SurfaceImages water_images(std::uint32_t seed);

}  // namespace kilolux
