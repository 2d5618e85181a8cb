// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/lights/light_ranges.h"

namespace kilolux {

/// Largest share of the light of lights without a range that Tails::bounded cuts at a point, 0 to
/// 1: of a grid's points in the scene's box, from side to side, and of the sum of at most 4096 of
/// the lights. Pictures of `deferred` without shadows and blended surfaces take Tails::tree for
/// Tails::automatic where it is more than a tenth, so that a picture of any part of the scene keeps
/// its light.
double bounded_loss(const Scene& scene, double error_budget = kDefaultRangeBudget);

}  // namespace kilolux
