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

/// Indices of the points that no other beats: that is, is as good in both and better in one.
///
/// Ascending by cost, then by index. Of equal points all are in the set or none; points with a NaN
/// are not.
///
/// `noises`: of measured costs (relative, one per point); none: exact ones. Differences below the
/// resolution count as equal: of costs kCostResolution or the sum of the two points' noises,
/// whichever is larger, of errors kErrorResolution. Of two settings that take the same time, the
/// more exact one is in the set.
std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    std::span<const double> noises = {});

inline constexpr double kCostResolution = 0.03;   // relative; bench --tune's, too
inline constexpr double kErrorResolution = 0.06;  // relative: 0.5 dB of PSNR

}  // namespace kilolux
