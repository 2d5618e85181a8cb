// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip_hdr.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "host/measure/metrics/parallel_rows.h"

namespace kilolux {
namespace {

// Share of the displayable range at which a tone-mapped pixel counts as just below white.
constexpr double kNotBurntOut = 0.85;

// (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5): Narkowicz 2015, "ACES Filmic Tone Mapping Curve", with
// its exposure bias of 0.6 in the constants.
constexpr double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03;
constexpr double k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

// The positive x at which the curve reaches t: the larger root of the quadratic.
double curve_inverse(double t) {
    const double a = k0 - t * k3;
    const double b = k1 - t * k4;
    const double c = -t * k5;
    const double root = std::sqrt(b * b - 4.0 * a * c);
    return std::max((-b + root) / (2.0 * a), (-b - root) / (2.0 * a));
}

// NaN stays, for flip_ldr() to see. A value large enough to overflow the quadratic is white.
double tone_mapped(double value, double factor) {
    if (std::isnan(value)) return value;
    const double x = std::max(value, 0.0) * factor;
    if (x > 1e100) return 1.0;
    return std::clamp(x * (k0 * x + k1) / (x * (k3 * x + k4) + k5), 0.0, 1.0);
}

// Luminances of the pixels that have one, ascending.
std::vector<double> sorted_luminances(const RgbImage& image) {
    std::vector<double> out;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        const double y = luminance(&image.rgb[i]);
        if (std::isfinite(y)) out.push_back(std::max(y, 0.0));
    }
    std::sort(out.begin(), out.end());
    return out;
}

double median(std::span<const double> sorted) {
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

}  // namespace

FlipExposures flip_exposures(const RgbImage& reference) {
    const std::vector<double> sorted = sorted_luminances(reference);
    const auto lit = std::upper_bound(sorted.begin(), sorted.end(), 0.0);
    if (lit == sorted.end()) return {};
    double middle = median(sorted);
    if (middle == 0.0) middle = median(std::span(lit, sorted.end()));
    const double white = curve_inverse(kNotBurntOut);
    FlipExposures out{.start = std::log2(white / sorted.back()), .stop = std::log2(white / middle)};
    out.count = std::max(2, static_cast<int>(std::ceil(out.stop - out.start)));
    return out;
}

RgbImage flip_tone_map(const RgbImage& image, double exposure_ev) {
    RgbImage out = image;
    const double factor = std::exp2(exposure_ev);
    const auto row = 3 * static_cast<std::size_t>(image.width);
    parallel_rows(image.height, [&](int y) {
        for (double& value : std::span(out.rgb).subspan(row * static_cast<std::size_t>(y), row)) {
            value = tone_mapped(value, factor);
        }
    });
    return out;
}

FlipResult flip_hdr(const RgbImage& picture, const RgbImage& reference, double pixels_per_degree) {
    require_same_size("HDR-FLIP", picture, reference);
    const FlipExposures exposures = flip_exposures(reference);
    const double step = (exposures.stop - exposures.start) / (exposures.count - 1);
    FlipResult out{.width = picture.width, .height = picture.height, .errors = {}, .error = {}};
    out.errors.resize(picture.pixel_count());
    for (int i = 0; i < exposures.count; ++i) {
        const double exposure = exposures.start + i * step;
        const FlipResult one = flip_ldr(flip_tone_map(picture, exposure),
                                        flip_tone_map(reference, exposure), pixels_per_degree);
        for (std::size_t p = 0; p < one.errors.size(); ++p) {
            out.errors[p] = std::max(out.errors[p], one.errors[p]);
        }
    }
    out.error = error_distribution(out.errors, out.width, 1);
    return out;
}

}  // namespace kilolux
