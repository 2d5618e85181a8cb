// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/lights/light_ranges.h"

namespace kilolux {

/// Share of the light of lights without a range that Tails::bounded cuts, 0 to 1: the mean over the
/// points of a grid in the scene's box, of at most 4096 of the lights. Pictures of `deferred`
/// without shadows take Tails::tree for Tails::automatic where it is more than a tenth.
double bounded_loss(const Scene& scene, double error_budget = kDefaultRangeBudget);

}  // namespace kilolux
