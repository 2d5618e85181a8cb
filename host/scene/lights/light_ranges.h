// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Largest error in radiance of one light without a range on a white diffuse surface: one step of
/// an 8-bit linear image whose white is 1.
inline constexpr double kDefaultRangeBudget = 1.0 / 256.0;

/// How lights without a range are treated.
///   exact       they reach every pixel, without a window
///   bounded     each gets the range of range_of_light()
///   stochastic  each gets a random range, at least that one, and weighs the more the less probable
///               it was to reach a point: the mean of many pictures is that of exact
///   tree        points reach every pixel, far ones in groups: nodes of a tree whose error is at
/// most
///               a stated share; spots are as with exact
///   automatic   exact for at most kExactTails lights, unless a budget is given; else bounded. The
///               number does not depend on the device: nor does the picture. The program asks
///               budget_of_sum() and has_blended_surfaces() first: see its choose_tails().
enum class Tails { automatic, exact, bounded, stochastic, tree };

/// Default error of a node of the light tree: see kernels/tails/tree_cut.h.
inline constexpr float kDefaultTreeShare = 0.3f;

/// Most lights without a range that `automatic` evaluates at every pixel.
inline constexpr std::size_t kExactTails = 128;

/// A range that no scene leaves [m]: positions are within 1e15 m, so the window (1 - (d/range)^4)
/// rounds to 1 wherever a light can be asked for.
inline constexpr float kUnlimitedRange = 1e18f;

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

/// Whether a point or spot light has no range (0) and can get one. One whose range or intensity is
/// negative or not finite is unusable, whatever its range.
bool lacks_range(const SceneLight& light);

/// Gives every light of `lights` that lacks_range() one, the least where they are random; `tails`
/// is not automatic.
void fill_missing_ranges(std::vector<SceneLight>& lights, Tails tails,
                         double error_budget = kDefaultRangeBudget);

/// The setting that `asked` stands for with these lights.
Tails tails_for(std::span<const SceneLight> lights, Tails asked, double error_budget);

}  // namespace kilolux
