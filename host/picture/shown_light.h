// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

namespace kilolux {

/// The linear light that a tone curve (TONE_CURVE_*) shows as `shown`, the display's linear colour
/// from 0 to 1, or as near to it as the curve comes: some curves show no saturated colours.
glm::dvec3 light_shown_as(const glm::dvec3& shown, int curve);

}  // namespace kilolux
