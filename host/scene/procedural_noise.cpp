// SPDX-License-Identifier: Apache-2.0
#include "host/scene/procedural_noise.h"

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

std::uint32_t lattice_bits(int x, int y, glm::ivec2 period, std::uint32_t seed) {
    const auto wrap = [](int i, int n) { return static_cast<std::uint32_t>(((i % n) + n) % n); };
    std::uint32_t h = seed + wrap(x, period.x) * 0x9e3779b9u + wrap(y, period.y) * 0x85ebca6bu;
    h = (h ^ (h >> 16)) * 0x7feb352du;  // "lowbias32", a 32-bit finaliser by C. Wellons
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

// Dot product of one of eight directions with d.
double gradient(std::uint32_t bits, double dx, double dy) {
    constexpr double kDiagonal = 0.70710678118654752;
    static constexpr double kDirections[8][2] = {{1, 0},
                                                 {-1, 0},
                                                 {0, 1},
                                                 {0, -1},
                                                 {kDiagonal, kDiagonal},
                                                 {-kDiagonal, kDiagonal},
                                                 {kDiagonal, -kDiagonal},
                                                 {-kDiagonal, -kDiagonal}};
    const double* direction = kDirections[bits >> 29];
    return direction[0] * dx + direction[1] * dy;
}

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double mix(double a, double b, double t) {
    return a + (b - a) * t;
}

}  // namespace

double lattice_value(int x, int y, int period, std::uint32_t seed) {
    return lattice_bits(x, y, glm::ivec2(period), seed) * 0x1p-32;
}

double gradient_noise(glm::dvec2 p, glm::ivec2 period, std::uint32_t seed) {
    const double fx = std::floor(p.x);
    const double fy = std::floor(p.y);
    const int x = static_cast<int>(fx);
    const int y = static_cast<int>(fy);
    const double dx = p.x - fx;
    const double dy = p.y - fy;
    const double a = gradient(lattice_bits(x, y, period, seed), dx, dy);
    const double b = gradient(lattice_bits(x + 1, y, period, seed), dx - 1.0, dy);
    const double c = gradient(lattice_bits(x, y + 1, period, seed), dx, dy - 1.0);
    const double d = gradient(lattice_bits(x + 1, y + 1, period, seed), dx - 1.0, dy - 1.0);
    const double t = fade(dx);
    return 1.4 * mix(mix(a, b, t), mix(c, d, t), fade(dy));
}

double fractal_noise(glm::dvec2 p, int period, int octaves, std::uint32_t seed) {
    double sum = 0.0;
    double amplitude = 0.55;
    int cells = period;
    for (int i = 0; i < octaves; ++i) {
        sum += amplitude * gradient_noise(p * static_cast<double>(cells), glm::ivec2(cells),
                                          seed + static_cast<std::uint32_t>(i) * 101u);
        amplitude *= 0.5;
        cells *= 2;
    }
    return sum;
}

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace kilolux
