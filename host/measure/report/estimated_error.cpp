// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/estimated_error.h"

#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/measure/metrics/compensated_sum.h"
#include "host/measure/metrics/statistics.h"
#include "host/scene/lights/light_ranges.h"

namespace kilolux {
namespace {

template <typename Value>
double root_mean_square(std::size_t count, Value value) {
    CompensatedSum squares;
    for (std::size_t i = 0; i < count; ++i) squares.add(value(i) * value(i));
    return count > 0 ? std::sqrt(squares.value() / static_cast<double>(count)) : 0.0;
}

ErrorEstimate compare_bound(const Layer& estimate, const RgbImage& picture,
                            const RgbImage& reference) {
    std::vector<double> bounds, errors;
    for (std::size_t i = 0; i < estimate.values.size(); ++i) {
        if (!(estimate.values[i] > 0.0f)) continue;
        bounds.push_back(estimate.values[i]);
        errors.push_back(std::abs(picture.rgb[i] - reference.rgb[i]));
    }
    if (bounds.empty()) return {EstimateKind::bound};
    std::ranges::sort(bounds);
    std::ranges::sort(errors);
    return {EstimateKind::bound, quantile(bounds, 0.5), quantile(errors, 0.5)};
}

ErrorEstimate compare_standard(const Layer& estimate, int samples, const RgbImage& picture,
                               const RgbImage& reference) {
    const std::size_t count = picture.pixel_count();
    // An AOV of several samples is that of the one through the pixels' centres.
    const double of_mean = 1.0 / std::sqrt(static_cast<double>(samples));
    ErrorEstimate out{EstimateKind::standard};
    out.estimated =
        root_mean_square(count, [&](std::size_t i) { return estimate.values[i] * of_mean; });
    out.error = root_mean_square(count, [&](std::size_t i) {
        return luminance(&picture.rgb[3 * i]) - luminance(&reference.rgb[3 * i]);
    });
    return out;
}

}  // namespace

std::optional<EstimateKind> estimate_kind(const Scene& scene, const RenderSettings& settings) {
    const bool unranged = std::ranges::any_of(scene.lights, lacks_range);
    const Tails tails = tails_for(scene.lights, settings.tails, settings.range_budget);
    const bool deferred = settings.renderer == RendererKind::deferred;
    if (unranged && tails == Tails::stochastic) {
        return deferred ? std::optional(EstimateKind::standard) : std::nullopt;
    }
    // A standard error does not contain the light that ranges take, nor a bound the noise of
    // shadows.
    if (settings.shadows == Shadows::sampled) {
        const bool loses = unranged && tails != Tails::exact;
        return loses ? std::nullopt : std::optional(EstimateKind::standard);
    }
    const bool bounded = unranged && (tails == Tails::bounded || tails == Tails::tree);
    return bounded && deferred ? std::optional(EstimateKind::bound) : std::nullopt;
}

const char* estimate_aov(EstimateKind kind) {
    return kind == EstimateKind::bound ? "error-bound" : "error-standard";
}

ErrorEstimate compare_estimate(EstimateKind kind, const Layer& estimate, int samples,
                               const RgbImage& picture, const RgbImage& reference) {
    require_same_size("estimated error", picture, reference);
    const bool bound = kind == EstimateKind::bound;
    if (estimate.values.size() != picture.pixel_count() * (bound ? 3 : 1)) {
        throw Error("estimated error: it has another size than the picture");
    }
    return bound ? compare_bound(estimate, picture, reference)
                 : compare_standard(estimate, samples, picture, reference);
}

double share_within(const Layer& standard, const RgbImage& picture, const MeanPicture& mean) {
    if (standard.values.size() != mean.variance.size() ||
        picture.pixel_count() != mean.variance.size()) {
        throw Error("estimated error: the mean has another size than the picture");
    }
    double noisy = 0.0, within = 0.0;
    for (std::size_t i = 0; i < mean.variance.size(); ++i) {
        const double variance = mean.variance[i] + double{standard.values[i]} * standard.values[i];
        if (!(variance > 0.0)) continue;
        ++noisy;
        within += is_within(luminance(&picture.rgb[3 * i]), variance, luminance(&mean.rgb[3 * i]));
    }
    return noisy > 0.0 ? within / noisy : 1.0;
}

}  // namespace kilolux
