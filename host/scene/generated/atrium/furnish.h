// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"

namespace kilolux {

/// Adds what stands and hangs in the atrium: urns, benches, trees, lanterns, banners and curtains.
/// `scene` has the atrium's materials; `seed` chooses colours and leaves.
void furnish_atrium(Scene& scene, std::uint64_t seed);

}  // namespace kilolux
