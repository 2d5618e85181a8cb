// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/pareto.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

namespace {

bool less(double a, double b, double resolution) {
    return a < b && b - a > resolution * std::min(std::abs(a), std::abs(b));
}

bool measured(const CostAndError& p) { return !std::isnan(p.cost) && !std::isnan(p.error); }

// Whether p beats q, where values closer than the relative resolutions are equal.
bool beats(const CostAndError& p, const CostAndError& q, double cost, double error) {
    if (less(q.cost, p.cost, cost) || less(q.error, p.error, error)) return false;
    return less(p.cost, q.cost, cost) || less(p.error, q.error, error);
}

// Indices of the points that no other beats. `cost(i, j)`: the resolution of two points' costs.
template <class Cost>
std::vector<std::size_t> unbeaten(std::span<const CostAndError> points, const Cost& cost,
                                  double error) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool beaten = !measured(points[i]);
        for (std::size_t j = 0; j < points.size() && !beaten; ++j) {
            beaten = measured(points[j]) && beats(points[j], points[i], cost(i, j), error);
        }
        if (!beaten) out.push_back(i);
    }
    std::ranges::stable_sort(out, {}, [&](std::size_t i) { return points[i].cost; });
    return out;
}

}  // namespace

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points) {
    return unbeaten(
        points, [](std::size_t, std::size_t) { return 0.0; }, 0.0);
}

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    std::span<const double> noises) {
    const auto cost = [&](std::size_t i, std::size_t j) {
        return std::max(kCostResolution, noises[i] + noises[j]);
    };
    return unbeaten(points, cost, kErrorResolution);
}

}  // namespace kilolux
