// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace kilolux {

/// Sub-pixel offset of a pixel's sample from its centre, in [-0.5, 0.5)^2 [pixel]. Sample 0 is the
/// centre. Additive recurrence R2 with the plastic number (Roberts 2018, "The Unreasonable
/// Effectiveness of Quasirandom Sequences"): any count of samples is evenly spread.
inline glm::dvec2 sample_offset(std::uint32_t sample) {
    // 1/g and 1/g^2 of the plastic number g, the real root of g^3 = g + 1.
    constexpr double kX = 0.7548776662466927;
    constexpr double kY = 0.5698402909980532;
    return glm::fract(glm::dvec2(0.5 + kX * sample, 0.5 + kY * sample)) - 0.5;
}

}  // namespace kilolux
