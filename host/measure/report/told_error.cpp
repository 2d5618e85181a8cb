// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/told_error.h"

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

ToldError compare_bound(const Layer& told, const RgbImage& picture, const RgbImage& reference) {
    std::vector<double> bounds, errors;
    for (std::size_t i = 0; i < told.values.size(); ++i) {
        if (!(told.values[i] > 0.0f)) continue;
        bounds.push_back(told.values[i]);
        errors.push_back(std::abs(picture.rgb[i] - reference.rgb[i]));
    }
    if (bounds.empty()) return {ErrorTold::bound};
    std::ranges::sort(bounds);
    std::ranges::sort(errors);
    return {ErrorTold::bound, quantile(bounds, 0.5), quantile(errors, 0.5)};
}

ToldError compare_standard(const Layer& told, int samples, const RgbImage& picture,
                           const RgbImage& reference) {
    const std::size_t count = picture.pixel_count();
    // An AOV of several samples is that of the one through the pixels' centres.
    const double of_mean = 1.0 / std::sqrt(static_cast<double>(samples));
    ToldError out{ErrorTold::standard};
    out.told = root_mean_square(count, [&](std::size_t i) { return told.values[i] * of_mean; });
    out.error = root_mean_square(count, [&](std::size_t i) {
        return luminance(&picture.rgb[3 * i]) - luminance(&reference.rgb[3 * i]);
    });
    return out;
}

}  // namespace

std::optional<ErrorTold> error_told_by(const Scene& scene, const RenderSettings& settings) {
    const bool unranged = std::ranges::any_of(scene.lights, lacks_range);
    const Tails tails = tails_for(scene.lights, settings.tails, settings.range_budget);
    const bool deferred = settings.renderer == RendererKind::deferred;
    if (unranged && tails == Tails::stochastic) {
        return deferred ? std::optional(ErrorTold::standard) : std::nullopt;
    }
    // A standard error does not contain the light that ranges take, nor a bound the noise of
    // shadows.
    if (settings.shadows == Shadows::sampled) {
        const bool loses = unranged && tails != Tails::exact;
        return loses ? std::nullopt : std::optional(ErrorTold::standard);
    }
    const bool bounded = unranged && (tails == Tails::bounded || tails == Tails::tree);
    return bounded && deferred ? std::optional(ErrorTold::bound) : std::nullopt;
}

const char* told_aov(ErrorTold kind) {
    return kind == ErrorTold::bound ? "error-bound" : "error-standard";
}

ToldError compare_told(ErrorTold kind, const Layer& told, int samples, const RgbImage& picture,
                       const RgbImage& reference) {
    require_same_size("told error", picture, reference);
    const bool bound = kind == ErrorTold::bound;
    if (told.values.size() != picture.pixel_count() * (bound ? 3 : 1)) {
        throw Error("told error: it has another size than the picture");
    }
    return bound ? compare_bound(told, picture, reference)
                 : compare_standard(told, samples, picture, reference);
}

}  // namespace kilolux
