// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip_ldr.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/measure/metrics/flip_color.h"
#include "host/measure/metrics/flip_filters.h"
#include "host/measure/metrics/parallel_rows.h"

namespace kilolux {
namespace {

// Andersson et al. 2020, section 4.3 and table 2.
constexpr double kColorExponent = 0.7;  // q_c
constexpr double kRemapBreak = 0.4;     // p_c
constexpr double kRemapValue = 0.95;    // p_t

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
    require_same_size("FLIP", picture.width, picture.height, reference.width, reference.height);
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
