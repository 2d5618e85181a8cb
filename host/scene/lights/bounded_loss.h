// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/lights/light_ranges.h"

namespace kilolux {

/// Largest share, 0 to 1, of light that the ranges of Tails::bounded cut at any point of a grid of
/// 5x5x5 in the box: of the sum of at most 4096 of the lights without a range.
double bounded_loss(std::span<const SceneLight> lights, const Box& box,
                    double error_budget = kDefaultRangeBudget);

/// What Tails::automatic takes where bounded ranges lose more than this share of the sum: a tree,
/// or longer ranges where a tree cannot light the picture.
inline constexpr double kMostLost = 0.1;

/// Most lights [a point, mean over the grid] that budget_of_sum() lets reach a point: lists and
/// shading cost as much as these.
inline constexpr double kMostInReach = 4096.0;

/// Halves the budget until bounded_loss() is at most kMostLost. Stops earlier if more than
/// kMostInReach lights would reach a point.
double budget_of_sum(std::span<const SceneLight> lights, const Box& box,
                     double error_budget = kDefaultRangeBudget);

}  // namespace kilolux
