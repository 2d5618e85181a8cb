// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace kilolux {
namespace {

constexpr double kPi = std::numbers::pi;

// a * sqrt(pi / b) * exp(-pi^2 x^2 / b), x in degrees: the filter of a CSF a * exp(-b f^2).
struct CsfTerm {
    double a;
    double b;
};

constexpr std::array<CsfTerm, 1> kAchromatic = {{{1.0, 0.0047}}};
constexpr std::array<CsfTerm, 1> kRedGreen = {{{1.0, 0.0053}}};
constexpr std::array<CsfTerm, 2> kBlueYellow = {{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double kWidest = 0.04;  // largest b: one radius serves all

constexpr double kFeatureWidth = 0.082;  // of an edge or point [degree]

std::vector<double> csf_taps(double b, double pixels_per_degree) {
    const double sigma = std::sqrt(b / (2.0 * kPi * kPi)) * pixels_per_degree;
    const double widest = std::sqrt(kWidest / (2.0 * kPi * kPi)) * pixels_per_degree;
    return gaussian_taps(sigma, static_cast<int>(std::ceil(3.0 * widest)));
}

// A sum of Gaussians is not separable, but each term is.
Plane filter_csf(const Plane& in, std::span<const CsfTerm> terms, double pixels_per_degree) {
    Plane out = make_plane(in.width, in.height);
    double total = 0.0;
    for (const CsfTerm& term : terms) {
        const auto taps = csf_taps(term.b, pixels_per_degree);
        const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
        const double weight = term.a * std::sqrt(kPi / term.b);
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

}  // namespace

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

}  // namespace kilolux
