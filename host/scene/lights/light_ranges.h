// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Largest error in radiance of one light without a range on a white diffuse surface: one step of
/// an 8-bit linear image whose white is 1.
inline constexpr double kDefaultRangeBudget = 1.0 / 256.0;

/// Range [m] for a light whose file gives none: where the radiance that it causes on a white
/// Lambert surface that faces it, intensity / (pi * d^2), has fallen to `error_budget`:
///
///     range = sqrt(intensity_max_cd / (pi * error_budget))
///
/// With that range the renderer's falloff, (1 - (d/range)^4) / d^2 and 0 beyond, differs nowhere
/// from the inverse square law by more than the budget: within the range the window removes
/// intensity * d^2 / (pi * range^4), which reaches the budget at the range; beyond it even less is
/// cut.
///
/// `intensity_max_cd`: the brightest colour channel [cd], >= 0. Throws Error when one of the two is
/// not finite, the intensity is negative or the budget is not positive.
double range_of_light(double intensity_max_cd, double error_budget = kDefaultRangeBudget);

/// Gives every point and spot light of `lights` without a range (0) the one of range_of_light().
/// Leaves lights alone whose range or intensity is negative or not finite: they are unusable.
/// Returns how many there were, so that the program can say so. Directional lights have none.
std::size_t fill_missing_ranges(std::vector<SceneLight>& lights,
                                double error_budget = kDefaultRangeBudget);

}  // namespace kilolux
