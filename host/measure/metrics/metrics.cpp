// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/metrics.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include "host/measure/metrics/compensated_sum.h"

namespace kilolux {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool same_value(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// Compares in float32, the best that a picture can hold of a reference in double.
bool same_bits(double a, double b) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(a)) ==
           std::bit_cast<std::uint32_t>(static_cast<float>(b));
}

double absolute_error(double x, double r) {
    if (same_value(x, r)) return 0.0;
    return std::isfinite(x) && std::isfinite(r) ? std::abs(x - r) : kInfinity;
}

double relative_error(double absolute, double r, double scale) {
    if (absolute == 0.0) return 0.0;
    if (std::isinf(absolute)) return kInfinity;
    return absolute / std::max(std::abs(r), scale);
}

double mean(std::span<const double> values) {
    return values.empty() ? 0.0 : compensated_sum(values) / static_cast<double>(values.size());
}

double percentile_99_9(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    const std::size_t rank = sorted.size() - sorted.size() / 1000;  // ceil(0.999 n)
    const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(sorted.begin(), nth, sorted.end());
    return *nth;
}

double largest_finite(const RgbImage& image) {
    double peak = 0.0;
    for (const double v : image.rgb) {
        if (std::isfinite(v)) peak = std::max(peak, v);
    }
    return peak;
}

void count_pixels(const RgbImage& picture, const RgbImage& reference, HdrMetrics& out) {
    out.pixels = picture.pixel_count();
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
        bool nan = false, infinite = false, negative = false, different = false;
        for (std::size_t c = i; c < i + 3; ++c) {
            nan |= std::isnan(picture.rgb[c]);
            infinite |= std::isinf(picture.rgb[c]);
            negative |= picture.rgb[c] < 0.0;
            different |= !same_bits(picture.rgb[c], reference.rgb[c]);
        }
        out.nan_pixels += nan;
        out.infinite_pixels += infinite;
        out.negative_pixels += negative;
        out.different_pixels += different;
    }
}

// (x-r)^2 / (r^2 + eps): Rousselle et al. 2011, with the offset relative to the mean of the
// reference's finite values.
double rel_mse(std::span<const double> absolute, const RgbImage& reference) {
    std::vector<double> finite;
    std::ranges::copy_if(reference.rgb, std::back_inserter(finite),
                         [](double r) { return std::isfinite(r); });
    const double average = mean(finite);
    const double eps = 1e-2 * average * average;
    CompensatedSum sum;
    for (std::size_t i = 0; i < absolute.size(); ++i) {
        const double r = reference.rgb[i];
        const double e = absolute[i];
        if (e > 0.0) sum.add(std::isinf(e) ? e : e * e / (r * r + eps));
    }
    return sum.value() / static_cast<double>(absolute.size());
}

double root_mean_square(std::span<const double> errors) {
    const double sum = compensated_sum(errors, [](double e) { return e * e; });
    return std::sqrt(sum / static_cast<double>(errors.size()));
}

}  // namespace

ErrorDistribution error_distribution(std::span<const double> errors, int width, int channels) {
    ErrorDistribution out;
    if (errors.empty()) return out;
    const auto worst = std::max_element(errors.begin(), errors.end());
    const auto index = worst - errors.begin();
    const auto pixel = index / channels;
    out.mean = mean(errors);
    out.percentile_99_9 = percentile_99_9(errors);
    out.max = *worst;
    out.x = static_cast<int>(pixel % width);
    out.y = static_cast<int>(pixel / width);
    out.channel = static_cast<int>(index % channels);
    return out;
}

std::string pixel_text(const ErrorDistribution& worst) {
    return fmt::format("{},{}", worst.x, worst.y);
}

HdrMetrics compare_hdr(const RgbImage& picture, const RgbImage& reference,
                       const HdrOptions& options) {
    require_same_size("compare", picture, reference);
    const RgbImage* scale = options.scale;
    if (scale) {
        require_same_size("compare: scale", *scale, picture);
    }
    std::vector<double> absolute(picture.rgb.size());
    std::vector<double> relative(picture.rgb.size());
    for (std::size_t i = 0; i < absolute.size(); ++i) {
        const double r = reference.rgb[i];
        absolute[i] = absolute_error(picture.rgb[i], r);
        relative[i] = relative_error(absolute[i], r, scale ? scale->rgb[i] : 0.0);
    }
    HdrMetrics out;
    count_pixels(picture, reference, out);
    out.absolute = error_distribution(absolute, picture.width, 3);
    out.relative = error_distribution(relative, picture.width, 3);
    out.rmse = root_mean_square(absolute);
    out.psnr_peak = options.psnr_peak > 0.0 ? options.psnr_peak : largest_finite(reference);
    out.psnr_db = out.rmse == 0.0 ? kInfinity : 20.0 * std::log10(out.psnr_peak / out.rmse);
    out.rel_mse = rel_mse(absolute, reference);
    return out;
}

std::vector<double> pixel_errors(const RgbImage& picture, const RgbImage& reference,
                                 const RgbImage* scale) {
    require_same_size("compare", picture, reference);
    std::vector<double> out(picture.pixel_count(), 0.0);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        const double x = picture.rgb[i], r = reference.rgb[i];
        const double unit = scale ? std::max(std::abs(r), scale->rgb[i]) : 1.0;
        const double error = x == r ? 0.0 : std::abs(x - r) / unit;
        double& worst = out[i / 3];
        if (std::isnan(error) || error > worst) worst = error;  // NaN stays
    }
    return out;
}

CodeDifferences compare_codes(const DisplayView& picture, const DisplayView& reference) {
    require_same_size("compare", picture, reference);
    CodeDifferences out;
    out.pixels = picture.rgba.size() / 4;
    std::vector<double> differences;
    for (std::size_t pixel = 0; pixel < out.pixels; ++pixel) {
        const std::size_t first = 4 * pixel;
        for (std::size_t c = first; c < first + 3; ++c) {
            differences.push_back(std::abs(picture.rgba[c] - reference.rgba[c]));
        }
        const auto* codes = &picture.rgba[first];
        out.different_pixels += !std::equal(codes, codes + 3, &reference.rgba[first]);
    }
    out.difference = error_distribution(differences, picture.width, 3);
    return out;
}

}  // namespace kilolux
