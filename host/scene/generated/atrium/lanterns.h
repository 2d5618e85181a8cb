// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"

namespace kilolux {

/// The atrium by night, lit by 263 lights with a size and a range: spheres (lanterns, strings of
/// bulbs, candles, a moon near the roof), rectangles (panels below the gallery's ceiling) and disks
/// (in the niches). All but the moon have a mesh that glows; it casts no shadow from its own light.
/// `seed`: as of make_atrium(), and of small differences between lamps.
Scene make_lanterns(std::uint64_t seed);

}  // namespace kilolux
