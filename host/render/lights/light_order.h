// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// The order in which kernels go through lights (kernels/shared/lights/light_order.h), range by
/// range: neighbours in space beside each other, so that a pixel's lights are near each other in
/// memory and in few blocks of its sum. Which of two lights comes first depends on these two alone;
/// equal places keep their order. Directional lights and lights that are not finite come last.
std::vector<std::uint32_t> order_by_place(std::span<const SceneLight> lights);

}  // namespace kilolux
