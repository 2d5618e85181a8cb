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

// Indices of the points that no other beats; `beats(a, b)` compares two indices.
template <class Beats>
std::vector<std::size_t> unbeaten(std::span<const CostAndError> points, const Beats& beats) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool beaten = !measured(points[i]);
        for (std::size_t j = 0; j < points.size() && !beaten; ++j) {
            beaten = measured(points[j]) && beats(j, i);
        }
        if (!beaten) out.push_back(i);
    }
    std::stable_sort(out.begin(), out.end(),
                     [&](std::size_t a, std::size_t b) { return points[a].cost < points[b].cost; });
    return out;
}

// Whether p beats q, where values closer than the relative resolutions are equal.
bool beats(const CostAndError& p, const CostAndError& q, double cost, double error) {
    if (less(q.cost, p.cost, cost) || less(q.error, p.error, error)) return false;
    return less(p.cost, q.cost, cost) || less(p.error, q.error, error);
}

}  // namespace

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points) {
    return unbeaten(points, [&](std::size_t a, std::size_t b) {
        return beats(points[a], points[b], 0.0, 0.0);
    });
}

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    std::span<const double> noises) {
    return unbeaten(points, [&](std::size_t a, std::size_t b) {
        const double resolution = std::max(kCostResolution, noises[a] + noises[b]);
        return beats(points[a], points[b], resolution, kErrorResolution);
    });
}

}  // namespace kilolux
