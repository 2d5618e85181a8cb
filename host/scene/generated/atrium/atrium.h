// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"

namespace kilolux {

/// A two-storeyed hall of columns round an open court with a fountain, about 31 x 12 x 18 m and
/// 250,000 triangles. `seed` changes stones, stains, leaves and what stands where, not the
/// building.
Scene make_atrium(std::uint64_t seed);

/// Adds the furniture of the atrium: urns, benches, trees, lanterns, banners and curtains. `scene`
/// has the atrium's materials; `seed` chooses colours and leaves.
void furnish_atrium(Scene& scene, std::uint64_t seed);

}  // namespace kilolux
