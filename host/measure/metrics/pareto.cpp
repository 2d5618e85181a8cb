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

}  // namespace

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    std::span<const double> noises) {
    const auto is_beaten_by = [&](std::size_t i, std::size_t j) {
        if (noises.empty()) return beats(points[j], points[i], 0.0, 0.0);
        const double cost = std::max(kCostResolution, noises[i] + noises[j]);
        return beats(points[j], points[i], cost, kErrorResolution);
    };
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool beaten = !measured(points[i]);
        for (std::size_t j = 0; j < points.size() && !beaten; ++j) {
            beaten = measured(points[j]) && is_beaten_by(i, j);
        }
        if (!beaten) out.push_back(i);
    }
    std::ranges::stable_sort(out, {}, [&](std::size_t i) { return points[i].cost; });
    return out;
}

}  // namespace kilolux
