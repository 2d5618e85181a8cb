// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "host/measure/metrics/flip_color.h"
#include "host/measure/metrics/parallel_rows.h"
#include "host/measure/metrics/separable_filter.h"

namespace kilolux {
namespace {

// Andersson et al. 2020, section 4.3 and table 2.
constexpr double kColorExponent = 0.7;  // q_c
constexpr double kRemapBreak = 0.4;     // p_c
constexpr double kRemapValue = 0.95;    // p_t

// Strength of edges and of points in a luminance plane of range 0..1 (ibid., section 4.2).
struct FlipFeatures {
    Plane edges;
    Plane points;
};

// A picture as FLIP compares it: blurred colours, and the edges and points before the blur.
struct Perceived {
    std::array<Plane, 3> hunt_lab;
    FlipFeatures features;
};

// NaN becomes 0, so that it does not spread through the filters.
double clamped(double v) { return v > 0.0 ? std::min(v, 1.0) : 0.0; }

glm::dvec3 color_at(const std::array<Plane, 3>& planes, std::size_t i) {
    return {planes[0].values[i], planes[1].values[i], planes[2].values[i]};
}

// Applies `map` to the colour of every pixel.
template <class Map>
void map_colors(std::array<Plane, 3>& planes, const Map& map) {
    const auto width = static_cast<std::size_t>(planes[0].width);
    parallel_rows(planes[0].height, [&](int y) {
        const std::size_t begin = static_cast<std::size_t>(y) * width;
        for (std::size_t i = begin; i < begin + width; ++i) {
            const glm::dvec3 color = map(color_at(planes, i));
            planes[0].values[i] = color.x;
            planes[1].values[i] = color.y;
            planes[2].values[i] = color.z;
        }
    });
}

std::array<Plane, 3> planes_of(const RgbImage& image) {
    std::array<Plane, 3> planes;
    for (std::size_t c = 0; c < 3; ++c) {
        planes[c] = make_plane(image.width, image.height);
        for (std::size_t i = 0; i < planes[c].values.size(); ++i) {
            planes[c].values[i] = clamped(image.rgb[3 * i + c]);
        }
    }
    return planes;
}

// a * sqrt(pi / b) * exp(-pi^2 x^2 / b), x in degrees: the filter of a CSF a * exp(-b f^2).
struct CsfTerm {
    double a;
    double b;
};

constexpr std::array<CsfTerm, 1> kAchromatic = {{{1.0, 0.0047}}};
constexpr std::array<CsfTerm, 1> kRedGreen = {{{1.0, 0.0053}}};
constexpr std::array<CsfTerm, 2> kBlueYellow = {{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double kLargestB = 0.04;  // of the b above [degree^2]; one radius serves all

constexpr double kFeatureWidth = 0.082;  // of an edge or point [degree]

std::vector<double> csf_taps(double b, double pixels_per_degree) {
    const double sigma =
        std::sqrt(b / (2.0 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree;
    const double widest =
        std::sqrt(kLargestB / (2.0 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree;
    return gaussian_taps(sigma, static_cast<int>(std::ceil(3.0 * widest)));
}

// A sum of Gaussians is not separable, but each term is.
Plane filter_csf(const Plane& in, std::span<const CsfTerm> terms, double pixels_per_degree) {
    Plane out = make_plane(in.width, in.height);
    double total = 0.0;
    for (const CsfTerm& term : terms) {
        const auto taps = csf_taps(term.b, pixels_per_degree);
        const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
        const double weight = term.a * std::sqrt(std::numbers::pi / term.b);
        const Plane filtered = filter_separable(in, taps, taps);
        for (std::size_t i = 0; i < out.values.size(); ++i) {
            out.values[i] += weight * filtered.values[i];
        }
        total += weight * sum * sum;
    }
    for (double& value : out.values) value /= total;
    return out;
}

// Positive taps sum to 1 and negative ones to -1: a step or a point of height 1 has strength 1.
std::vector<double> balanced(std::vector<double> taps) {
    double positive = 0.0, negative = 0.0;
    for (const double tap : taps) (tap > 0.0 ? positive : negative) += std::abs(tap);
    for (double& tap : taps) tap /= tap > 0.0 ? positive : negative;
    return taps;
}

// First and second derivative of a Gaussian, and the Gaussian itself.
struct FeatureTaps {
    std::vector<double> smooth, first, second;
};

FeatureTaps feature_taps(double pixels_per_degree) {
    const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    FeatureTaps taps{gaussian_taps(sigma, radius), {}, {}};
    for (int x = -radius; x <= radius; ++x) {
        const int place = x + radius;
        const double g = taps.smooth[static_cast<std::size_t>(place)];
        taps.first.push_back(-x * g);
        taps.second.push_back((x * x / (sigma * sigma) - 1.0) * g);
    }
    return {normalized(taps.smooth), balanced(taps.first), balanced(taps.second)};
}

Plane gradient_length(const Plane& in, const std::vector<double>& derivative,
                      const std::vector<double>& smooth) {
    Plane along_x = filter_separable(in, derivative, smooth);
    const Plane along_y = filter_separable(in, smooth, derivative);
    for (std::size_t i = 0; i < along_x.values.size(); ++i) {
        const double x = along_x.values[i];
        const double y = along_y.values[i];
        along_x.values[i] = std::sqrt(x * x + y * y);
    }
    return along_x;
}

// Blurs the three opponent planes as the eye does at this distance, by the contrast sensitivity
// functions of section 4.1.1 and table 1, as Gaussians.
std::array<Plane, 3> filter_contrast(const std::array<Plane, 3>& ycxcz, double pixels_per_degree) {
    return {filter_csf(ycxcz[0], kAchromatic, pixels_per_degree),
            filter_csf(ycxcz[1], kRedGreen, pixels_per_degree),
            filter_csf(ycxcz[2], kBlueYellow, pixels_per_degree)};
}

FlipFeatures detect_features(const Plane& luminance, double pixels_per_degree) {
    const FeatureTaps taps = feature_taps(pixels_per_degree);
    return {gradient_length(luminance, taps.first, taps.smooth),
            gradient_length(luminance, taps.second, taps.smooth)};
}

Perceived perceive(const RgbImage& image, double pixels_per_degree) {
    std::array<Plane, 3> planes = planes_of(image);
    map_colors(planes, ycxcz_from_linear);
    Plane luminance = planes[0];
    for (double& y : luminance.values) y = (y + 16.0) / 116.0;
    FlipFeatures features = detect_features(luminance, pixels_per_degree);
    planes = filter_contrast(planes, pixels_per_degree);
    map_colors(planes, [](const glm::dvec3& ycxcz) {
        const glm::dvec3 rgb = linear_from_ycxcz(ycxcz);
        return hunt_lab_from_linear({clamped(rgb[0]), clamped(rgb[1]), clamped(rgb[2])});
    });
    return {std::move(planes), std::move(features)};
}

// The largest colour error within the gamut: between green and blue.
double largest_color_error() {
    const glm::dvec3 green = hunt_lab_from_linear({0.0, 1.0, 0.0});
    const glm::dvec3 blue = hunt_lab_from_linear({0.0, 0.0, 1.0});
    return std::pow(hyab_distance(green, blue), kColorExponent);
}

// Maps small colour errors to most of [0, 1]; large differences all look alike.
double remapped(double color_error, double largest) {
    const double knee = kRemapBreak * largest;
    if (color_error < knee) return color_error * kRemapValue / knee;
    return kRemapValue + (color_error - knee) / (largest - knee) * (1.0 - kRemapValue);
}

double pixel_error(const Perceived& a, const Perceived& b, std::size_t i, double largest) {
    const double distance = hyab_distance(color_at(a.hunt_lab, i), color_at(b.hunt_lab, i));
    const double color = remapped(std::pow(distance, kColorExponent), largest);
    const double edge = std::abs(a.features.edges.values[i] - b.features.edges.values[i]);
    const double point = std::abs(a.features.points.values[i] - b.features.points.values[i]);
    const double feature =
        std::sqrt(std::max(edge, point) * std::numbers::sqrt2 / 2.0);  // q_f = 0.5
    return std::pow(color, 1.0 - feature);
}

bool nan_at(const RgbImage& image, std::size_t i) {
    return std::isnan(image.rgb[3 * i]) || std::isnan(image.rgb[3 * i + 1]) ||
           std::isnan(image.rgb[3 * i + 2]);
}

}  // namespace

FlipResult flip_ldr(const RgbImage& picture, const RgbImage& reference, double pixels_per_degree) {
    require_same_size("FLIP", picture, reference);
    const Perceived a = perceive(picture, pixels_per_degree);
    const Perceived b = perceive(reference, pixels_per_degree);
    const double largest = largest_color_error();
    FlipResult out{.width = picture.width, .height = picture.height, .errors = {}, .error = {}};
    out.errors.resize(picture.pixel_count());
    const auto width = static_cast<std::size_t>(picture.width);
    parallel_rows(picture.height, [&](int y) {
        const std::size_t begin = static_cast<std::size_t>(y) * width;
        for (std::size_t i = begin; i < begin + width; ++i) {
            const bool nan_in_one = nan_at(picture, i) != nan_at(reference, i);
            out.errors[i] = nan_in_one ? 1.0 : pixel_error(a, b, i, largest);
        }
    });
    out.error = error_distribution(out.errors, out.width, 1);
    return out;
}

}  // namespace kilolux
