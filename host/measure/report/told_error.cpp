// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/told_error.h"

#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/measure/metrics/compensated_sum.h"
#include "host/scene/lights/light_ranges.h"

namespace kilolux {
namespace {

template <typename Value>
double root_mean_square(std::size_t count, Value value) {
    CompensatedSum squares;
    for (std::size_t i = 0; i < count; ++i) squares.add(value(i) * value(i));
    return count > 0 ? std::sqrt(squares.value() / static_cast<double>(count)) : 0.0;
}

}  // namespace

std::optional<ErrorTold> error_told_by(const Scene& scene, const RenderSettings& settings) {
    const bool unranged = std::ranges::any_of(scene.lights, lacks_range);
    const Tails tails = tails_for(scene.lights, settings.tails, settings.range_budget);
    const bool deferred = settings.renderer == RendererKind::deferred;
    if (unranged && tails == Tails::stochastic) {
        return deferred ? std::optional(ErrorTold::standard) : std::nullopt;
    }
    // Light that ranges take is no part of a standard error, nor noise of a bound.
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
    const std::size_t count = picture.pixel_count() * (bound ? 3 : 1);
    if (told.values.size() != count)
        throw Error("told error: it has another size than the picture");
    ToldError out{kind};
    // An AOV of several samples is the mean of what each tells of itself.
    const double shrink = bound ? 1.0 : std::sqrt(static_cast<double>(samples));
    out.told = root_mean_square(count, [&](std::size_t i) { return told.values[i] / shrink; });
    out.error = root_mean_square(count, [&](std::size_t i) {
        if (bound) return picture.rgb[i] - reference.rgb[i];
        return luminance(&picture.rgb[3 * i]) - luminance(&reference.rgb[3 * i]);
    });
    return out;
}

}  // namespace kilolux
