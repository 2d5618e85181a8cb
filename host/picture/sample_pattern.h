// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace kilolux {

/// Sub-pixel offset of a pixel's sample from its centre, in [-0.5, 0.5)^2 [pixel]. Sample 0 is the
/// centre. Additive recurrence R2 with the plastic number (Roberts 2018, "The Unreasonable
/// Effectiveness of Quasirandom Sequences"): any count of samples is evenly spread.
glm::dvec2 sample_offset(std::uint32_t sample);

}  // namespace kilolux
