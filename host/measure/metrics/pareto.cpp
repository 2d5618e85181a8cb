// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/pareto.h"

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

bool is_measured(const CostAndError& p) { return !std::isnan(p.cost) && !std::isnan(p.error); }

// The number of the step that `value` is in; values themselves without a resolution.
double step_of(double value, double first, double resolution) {
    if (resolution <= 0.0) return value;
    const double middle = first > 0.0 && std::isfinite(first) ? first : 1.0;
    return std::round(std::log(value / middle) / (2.0 * std::log1p(resolution)));
}

bool beats(const CostAndError& p, const CostAndError& q) {
    return p.cost <= q.cost && p.error <= q.error && (p.cost < q.cost || p.error < q.error);
}

}  // namespace

std::vector<std::size_t> pareto_set(std::span<const CostAndError> points,
                                    const ParetoResolution& resolution) {
    std::vector<CostAndError> steps;
    for (const CostAndError& p : points) {
        steps.push_back({step_of(p.cost, points.front().cost, resolution.cost),
                         step_of(p.error, points.front().error, resolution.error)});
    }
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const bool beaten = std::ranges::any_of(
            steps, [&](const CostAndError& p) { return is_measured(p) && beats(p, steps[i]); });
        if (is_measured(steps[i]) && !beaten) out.push_back(i);
    }
    std::ranges::stable_sort(out, {}, [&](std::size_t i) { return points[i].cost; });
    return out;
}

}  // namespace kilolux
