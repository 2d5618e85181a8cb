// SPDX-License-Identifier: Apache-2.0
#include "host/measure/pareto.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!std::isnan(points[i].cost) && !std::isnan(points[i].error)) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
        return points[a].error < points[b].error;
    });
    // Going up in cost, a point must have less error than all cheaper ones, or equal the last
    // taken.
    std::vector<std::size_t> out;
    for (const std::size_t i : order) {
        const bool first = out.empty();
        const bool better = first || points[i].error < points[out.back()].error;
        const bool same = !first && points[i].error == points[out.back()].error &&
                          points[i].cost == points[out.back()].cost;
        if (better || same) out.push_back(i);
    }
    return out;
}

}  // namespace kilolux
