// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kilolux {

/// A setting's price and its error; of both, less is better.
struct CostAndError {
    double cost = 0.0;  // e.g. [ms]
    double error = 0.0;
};

/// Indices of the settings that no other beats: none is at least as good in both and better in one.
///
/// Ascending by cost, then by index. Equal points are all in the set or none; points with a NaN
/// never are.
std::vector<std::size_t> pareto_set(std::span<const CostAndError> points);

/// The same, for costs that were measured: what cannot be told apart counts as equal.
///
/// A setting beats another if it is not worse in either by more than the tolerance, and better in
/// one by more. Costs a and b differ if they are further apart than the larger of kCostResolution
/// and their two `noises` together (relative, one a point); errors, if by more than
/// kErrorResolution. So of two that take the same time the more exact one is in the set.
std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    std::span<const double> noises);

inline constexpr double kCostResolution = 0.03;   // relative; bench --tune calls less noise, too
inline constexpr double kErrorResolution = 0.06;  // relative: 0.5 dB of PSNR

}  // namespace kilolux
