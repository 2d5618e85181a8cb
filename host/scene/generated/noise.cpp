// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/noise.h"

namespace kilolux {
namespace {

constexpr std::uint32_t kAcross = 0x9e3779b9u;  // odd factors that tell x and y apart
constexpr std::uint32_t kDown = 0x85ebca6bu;

std::uint32_t wrapped(int i, int period) {
    const bool inside = i >= 0 && i < period;
    return static_cast<std::uint32_t>(inside ? i : ((i % period) + period) % period);
}

// "lowbias32", a 32-bit finaliser by C. Wellons.
std::uint32_t mixed(std::uint32_t h) {
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

// std::floor is a call where the compiler may not assume SSE 4.1.
int noise_floor(double x) {
    const int i = static_cast<int>(x);
    return i - (x < i ? 1 : 0);
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

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double lattice_value(int x, int y, int period, std::uint32_t seed) {
    return mixed(seed + wrapped(x, period) * kAcross + wrapped(y, period) * kDown) * 0x1p-32;
}

double gradient_noise(glm::dvec2 p, glm::ivec2 period, std::uint32_t seed) {
    const int x = noise_floor(p.x);
    const int y = noise_floor(p.y);
    const double dx = p.x - x;
    const double dy = p.y - y;
    const std::uint32_t left = seed + wrapped(x, period.x) * kAcross;
    const std::uint32_t right = seed + wrapped(x + 1, period.x) * kAcross;
    const std::uint32_t top = wrapped(y, period.y) * kDown;
    const std::uint32_t bottom = wrapped(y + 1, period.y) * kDown;
    const double a = gradient(mixed(left + top), dx, dy);
    const double b = gradient(mixed(right + top), dx - 1.0, dy);
    const double c = gradient(mixed(left + bottom), dx, dy - 1.0);
    const double d = gradient(mixed(right + bottom), dx - 1.0, dy - 1.0);
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

}  // namespace kilolux
