// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/pareto.h"

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

namespace {

bool apart(double a, double b, double resolution) {
    return std::abs(a - b) > resolution * std::min(std::abs(a), std::abs(b));
}

bool less(double a, double b, double resolution) { return a < b && apart(a, b, resolution); }

}  // namespace

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    std::span<const double> noises) {
    const auto beats = [&](std::size_t a, std::size_t b) {
        const double resolution = std::max(kCostResolution, noises[a] + noises[b]);
        const CostAndError &p = points[a], &q = points[b];
        const bool not_worse =
            !less(q.cost, p.cost, resolution) && !less(q.error, p.error, kErrorResolution);
        return not_worse &&
               (less(p.cost, q.cost, resolution) || less(p.error, q.error, kErrorResolution));
    };
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::isnan(points[i].cost) || std::isnan(points[i].error)) continue;
        bool beaten = false;
        for (std::size_t j = 0; j < points.size() && !beaten; ++j) {
            const bool measured = !std::isnan(points[j].cost) && !std::isnan(points[j].error);
            beaten = measured && beats(j, i);
        }
        if (!beaten) out.push_back(i);
    }
    std::stable_sort(out.begin(), out.end(),
                     [&](std::size_t a, std::size_t b) { return points[a].cost < points[b].cost; });
    return out;
}

}  // namespace kilolux
