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

}  // namespace kilolux
