// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/lights/light_ranges.h"

namespace kilolux {

/// Largest share of the light of those of `lights` without a range that Tails::bounded cuts at a
/// point, 0 to 1: of a grid's points in the box, from side to side, and of the sum of at most 4096
/// of the lights.
double bounded_loss(std::span<const SceneLight> lights, const Box& box,
                    double error_budget = kDefaultRangeBudget);

/// What Tails::automatic takes where bounded ranges lose more than this share of the sum: a tree,
/// or longer ranges where a tree cannot light the picture.
inline constexpr double kMostLost = 0.1;

/// Most lights [a point, mean over the grid] that budget_of_sum() lets reach a point: lists and
/// shading cost as much as these.
inline constexpr double kMostInReach = 4096.0;

/// The largest of error_budget, error_budget / 2, error_budget / 4 ... with which bounded_loss() is
/// at most kMostLost; a larger one where more than kMostInReach lights would reach a point.
double budget_of_sum(std::span<const SceneLight> lights, const Box& box,
                     double error_budget = kDefaultRangeBudget);

}  // namespace kilolux
