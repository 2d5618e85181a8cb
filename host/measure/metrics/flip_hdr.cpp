// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip_hdr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "host/base/error.h"
#include "host/measure/metrics/parallel_rows.h"

namespace kilolux {
namespace {

// Of the displayable range: where a tone-mapped pixel counts as just not burnt out.
constexpr double kNotBurntOut = 0.85;

// (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5).
struct RationalCurve {
    double k0, k1, k3, k4, k5;
    double operator()(double x) const { return x * (k0 * x + k1) / (x * (k3 * x + k4) + k5); }
};

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve", with its exposure bias of 0.6 in the constants.
constexpr RationalCurve kAces = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

// Hable 2010, "Uncharted 2: HDR Lighting", with exposure bias 2 and linear white 11.2. The curve is
// (x (A x + C B) + D E) / (x (A x + B) + D F) - E / F, brought over one denominator.
constexpr RationalCurve hable_curve() {
    constexpr double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30, white = 11.2;
    constexpr double k0 = A * F - A * E, k1 = C * B * F - B * E;
    constexpr double k3 = A * F, k4 = B * F, k5 = D * F * F;
    constexpr double scale =
        (k3 * white * white + k4 * white + k5) / (k0 * white * white + k1 * white);
    return {4.0 * k0 * scale, 2.0 * k1 * scale, 4.0 * k3, 2.0 * k4, k5};
}

// Reinhard et al. 2002, x / (1 + x), as a rational curve of luminance.
constexpr RationalCurve kReinhard = {0.0, 1.0, 0.0, 1.0, 1.0};

RationalCurve curve_of(FlipToneMapper tone_mapper) {
    switch (tone_mapper) {
        case FlipToneMapper::hable:
            return hable_curve();
        case FlipToneMapper::reinhard:
            return kReinhard;
        case FlipToneMapper::aces:
            break;
    }
    return kAces;
}

double luminance(const double* rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

// The positive x at which the curve reaches t: the larger root of the quadratic.
double curve_inverse(const RationalCurve& curve, double t) {
    const double a = curve.k0 - t * curve.k3;
    const double b = curve.k1 - t * curve.k4;
    const double c = -t * curve.k5;
    if (a == 0.0) return -c / b;
    const double root = std::sqrt(b * b - 4.0 * a * c);
    return std::max((-b + root) / (2.0 * a), (-b - root) / (2.0 * a));
}

double clamped01(double v) { return v > 0.0 ? std::min(v, 1.0) : 0.0; }

// A value large enough to overflow the quadratic is far beyond white.
double tone_mapped(const RationalCurve& curve, double x) {
    return x > 1e100 ? 1.0 : clamped01(curve(x));
}

std::array<double, 3> tone_mapped(FlipToneMapper tone_mapper, const RationalCurve& curve,
                                  const std::array<double, 3>& x) {
    if (tone_mapper != FlipToneMapper::reinhard) {
        return {tone_mapped(curve, x[0]), tone_mapped(curve, x[1]), tone_mapped(curve, x[2])};
    }
    const double scale = 1.0 / (1.0 + luminance(x.data()));
    const auto scaled = [&](double v) { return std::isinf(v) ? 1.0 : clamped01(v * scale); };
    return {scaled(x[0]), scaled(x[1]), scaled(x[2])};
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

FlipExposures automatic_exposures(const RgbImage& reference, FlipToneMapper tone_mapper) {
    const std::vector<double> sorted = sorted_luminances(reference);
    const auto lit = std::upper_bound(sorted.begin(), sorted.end(), 0.0);
    if (lit == sorted.end()) return {};
    double middle = median(sorted);
    if (middle == 0.0) middle = median(std::span(lit, sorted.end()));
    const double white = curve_inverse(curve_of(tone_mapper), kNotBurntOut);
    return {.start = std::log2(white / sorted.back()), .stop = std::log2(white / middle)};
}

// NaN stays, for flip_ldr() to see.
double exposed(double value, double factor) {
    return std::isnan(value) ? value : std::max(value, 0.0) * factor;
}

}  // namespace

FlipExposures flip_exposures(const RgbImage& reference, const FlipHdrOptions& options) {
    FlipExposures out = automatic_exposures(reference, options.tone_mapper);
    out.start = options.start_exposure.value_or(out.start);
    out.stop = options.stop_exposure.value_or(out.stop);
    if (!(out.start <= out.stop)) {
        throw Error("HDR-FLIP: start exposure " + std::to_string(out.start) +
                    " EV is above stop exposure " + std::to_string(out.stop) + " EV");
    }
    const int count = options.exposure_count > 0
                          ? options.exposure_count
                          : static_cast<int>(std::ceil(out.stop - out.start));
    out.count = std::max(2, count);
    return out;
}

RgbImage flip_tone_map(const RgbImage& image, double exposure_ev, FlipToneMapper tone_mapper) {
    RgbImage out = make_rgb_image(image.width, image.height);
    const RationalCurve curve = curve_of(tone_mapper);
    const double factor = std::exp2(exposure_ev);
    const auto width = static_cast<std::size_t>(image.width);
    parallel_rows(image.height, [&](int y) {
        const std::size_t begin = 3 * width * static_cast<std::size_t>(y);
        for (std::size_t i = begin; i < begin + 3 * width; i += 3) {
            const std::array<double, 3> x = {exposed(image.rgb[i], factor),
                                             exposed(image.rgb[i + 1], factor),
                                             exposed(image.rgb[i + 2], factor)};
            const std::array<double, 3> mapped = tone_mapped(tone_mapper, curve, x);
            for (std::size_t c = 0; c < 3; ++c) {
                out.rgb[i + c] = std::isnan(x[c]) ? x[c] : mapped[c];
            }
        }
    });
    return out;
}

FlipHdrResult flip_hdr(const RgbImage& picture, const RgbImage& reference,
                       const FlipHdrOptions& options) {
    require_same_size("HDR-FLIP", picture.width, picture.height, reference.width, reference.height);
    FlipHdrResult out{.flip = {}, .exposures = flip_exposures(reference, options)};
    const double step = (out.exposures.stop - out.exposures.start) / (out.exposures.count - 1);
    for (int i = 0; i < out.exposures.count; ++i) {
        const double exposure = out.exposures.start + i * step;
        FlipResult one = flip_ldr(flip_tone_map(picture, exposure, options.tone_mapper),
                                  flip_tone_map(reference, exposure, options.tone_mapper),
                                  options.pixels_per_degree);
        if (i == 0) {
            out.flip = std::move(one);
            continue;
        }
        for (std::size_t p = 0; p < one.errors.size(); ++p) {
            out.flip.errors[p] = std::max(out.flip.errors[p], one.errors[p]);
        }
    }
    out.flip.error = error_distribution(out.flip.errors, out.flip.width, 1);
    return out;
}

}  // namespace kilolux
