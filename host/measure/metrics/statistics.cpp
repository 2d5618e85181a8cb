// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/measure/metrics/compensated_sum.h"

namespace kilolux {

double quantile(std::span<const double> sorted, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
    const auto lower = static_cast<std::size_t>(at);
    const std::size_t upper = std::min(lower + 1, sorted.size() - 1);
    // Two equal neighbours, infinite ones too, need no interpolation.
    if (sorted[lower] == sorted[upper]) return sorted[lower];
    return sorted[lower] + (at - static_cast<double>(lower)) * (sorted[upper] - sorted[lower]);
}

double notch(std::span<const double> sorted) {
    const double spread = quantile(sorted, 0.75) - quantile(sorted, 0.25);
    return 1.57 * spread / std::sqrt(static_cast<double>(sorted.size()));
}

Statistics statistics(std::span<const double> values) {
    Statistics out;
    out.count = values.size();
    if (values.empty()) return out;
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        return {values.size(), nan, nan, nan, nan, nan, nan};
    }
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    out.min = sorted.front();
    out.p5 = quantile(sorted, 0.05);
    out.median = quantile(sorted, 0.5);
    out.p95 = quantile(sorted, 0.95);
    out.max = sorted.back();
    out.mean = compensated_sum(sorted) / static_cast<double>(sorted.size());
    return out;
}

bool is_within(double estimate, double variance, double truth) {
    constexpr double kNormalQuantile = 1.959964;
    return std::abs(estimate - truth) <= kNormalQuantile * std::sqrt(variance);
}

}  // namespace kilolux
