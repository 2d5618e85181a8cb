// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kilolux {

/// Cost and error of a setting; less is better for both.
struct CostAndError {
    double cost = 0.0;  // e.g. [ms]
    double error = 0.0;
};

/// The relative difference from which two values count as different; 0: any difference does.
struct ParetoResolution {
    double cost = 0.0, error = 0.0;
};

/// Indices of the points that no other beats: that is, is as good in both and better in one.
///
/// Ascending by cost, then by index. Of equal points all are in the set or none; points with a NaN
/// are not.
///
/// With a resolution values are compared by steps, twice as wide as it and counted from the first
/// point, which is in the middle of its step: values of one step are equal. So "beats" is
/// transitive, and every point outside the set is beaten by a point of the set.
std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    const ParetoResolution& resolution = {});

inline constexpr double kCostResolution = 0.03;   // relative; bench --tune's, too
inline constexpr double kErrorResolution = 0.06;  // relative: 0.5 dB of PSNR

}  // namespace kilolux
