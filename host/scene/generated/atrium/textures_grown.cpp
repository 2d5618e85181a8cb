// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/textures.h"
#include "host/scene/generated/noise.h"

namespace kilolux {
namespace {

// 1 on the zero lines of a noise, falling off at both sides.
double vein(double noise, double sharpness) {
    return std::pow(std::max(1.0 - std::abs(noise), 0.0), sharpness);
}

}  // namespace

SurfaceImages marble_images(std::uint32_t seed) {
    return bake({.name = "marble", .metres = 2.0}, [seed](double u, double v) {
        const double wu = u + 0.07 * fractal_noise({u, v}, 3, 4, seed);
        const double wv = v + 0.07 * fractal_noise({u, v}, 3, 4, seed + 50u);
        const double coarse = vein(1.5 * fractal_noise({wu, wv}, 2, 3, seed + 1u), 18.0);
        const double fine = vein(1.5 * fractal_noise({wv, wu}, 5, 4, seed + 2u), 10.0);
        const double cloud = fractal_noise({u, v}, 4, 4, seed + 3u);
        Texel t;
        t.color = glm::dvec3(0.885, 0.865, 0.83) * (1.0 + 0.06 * cloud);
        t.color = glm::mix(t.color, glm::dvec3(0.60, 0.585, 0.575), 0.55 * coarse);
        t.color = glm::mix(t.color, glm::dvec3(0.74, 0.69, 0.60), 0.30 * fine);
        return t;
    });
}

SurfaceImages limestone_images(std::uint32_t seed) {
    return bake({.name = "limestone", .metres = 2.0}, [seed](double u, double v) {
        const double grain = fractal_noise({u, v}, 32, 4, seed);
        const double cloud = fractal_noise({u, v}, 4, 5, seed + 1u);
        const double pit = glm::smoothstep(0.30, 0.45, fractal_noise({u, v}, 40, 2, seed + 2u));
        Texel t;
        t.color = glm::dvec3(0.815, 0.745, 0.625) * (1.0 + 0.07 * grain + 0.10 * cloud);
        t.color *= 1.0 - 0.22 * pit;
        return t;
    });
}

SurfaceImages plaster_images(std::uint32_t seed) {
    const BakeOptions options{.name = "plaster", .metres = 3.2, .normal = true};
    return bake(options, [seed](double u, double v) {
        const double grain = fractal_noise({u, v}, 40, 4, seed);
        const double trowel = fractal_noise({u, v}, 9, 3, seed + 1u);
        const double stain = fractal_noise({u, v}, 3, 5, seed + 2u);
        const double crack = vein(2.2 * fractal_noise({u, v}, 4, 5, seed + 3u), 60.0) *
                             glm::smoothstep(0.05, 0.35, fractal_noise({u, v}, 2, 3, seed + 4u));
        Texel t;
        t.color = glm::mix(glm::dvec3(0.83, 0.67, 0.46), glm::dvec3(0.88, 0.78, 0.61),
                           glm::smoothstep(-0.45, 0.45, stain));
        t.color *= (1.0 + 0.05 * grain + 0.05 * trowel) * (1.0 - 0.3 * crack);
        t.height = 0.0045 * trowel + 0.0011 * grain - 0.002 * crack;
        return t;
    });
}

SurfaceImages wood_images(std::uint32_t seed) {
    const BakeOptions options{.name = "wood", .metres = 1.6, .normal = true};
    return bake(options, [seed](double u, double v) {
        constexpr int kPlanks = 6;
        const int plank = static_cast<int>(v * kPlanks);
        const double across = v * kPlanks - plank;
        const double tone = lattice_value(plank, 3, kPlanks, seed);
        const double bend = fractal_noise({u, v}, 3, 3, seed + 1u);
        // Grain lines follow the plank with noise; whole periods keep the texture tiling.
        const double rings =
            0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * (9.0 * v * kPlanks + 3.0 * bend + tone));
        const double fibre = gradient_noise({u * 8.0, v * 128.0}, {8, 128}, seed + 2u);
        const double fade = fractal_noise({u, v}, 4, 4, seed + 3u);
        const double gap = 1.0 - glm::smoothstep(0.012, 0.035, std::min(across, 1.0 - across));
        Texel t;
        t.color = glm::mix(glm::dvec3(0.40, 0.25, 0.15), glm::dvec3(0.55, 0.37, 0.22), tone);
        t.color *= (1.0 - 0.16 * rings + 0.07 * fibre + 0.10 * fade) * (1.0 - 0.6 * gap);
        t.height = 0.0005 * rings + 0.0004 * fibre - 0.006 * gap;
        return t;
    });
}

SurfaceImages terracotta_images(std::uint32_t seed) {
    return bake({.name = "terracotta", .size = 256, .metres = 0.8}, [seed](double u, double v) {
        const double grain = fractal_noise({u, v}, 16, 4, seed);
        const double cloud = fractal_noise({u, v}, 3, 4, seed + 1u);
        const double lime = glm::smoothstep(0.25, 0.6, fractal_noise({u, v}, 5, 4, seed + 2u));
        Texel t;
        t.color = glm::dvec3(0.70, 0.42, 0.29) * (1.0 + 0.10 * grain + 0.14 * cloud);
        t.color = glm::mix(t.color, glm::dvec3(0.80, 0.71, 0.61), 0.4 * lime);
        return t;
    });
}

SurfaceImages cloth_images(std::uint32_t seed) {
    return bake({.name = "cloth", .metres = 0.8}, [seed](double u, double v) {
        // Damask: a flower on a half-drop lattice, only brighter than the ground.
        const glm::dvec2 cell = glm::dvec2(u, v) * 4.0;
        const double shift = 0.5 * (static_cast<int>(cell.x) % 2);
        const glm::dvec2 p = glm::fract(glm::dvec2(cell.x, cell.y + shift)) - 0.5;
        const double angle = std::atan2(p.y, p.x);
        const double petal = 0.24 + 0.13 * std::cos(6.0 * angle);
        const double flower = 1.0 - glm::smoothstep(petal - 0.03, petal + 0.03, glm::length(p));
        const double ring = 1.0 - glm::smoothstep(0.0, 0.035, std::abs(glm::length(p) - 0.44));
        const double thread = 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * 128.0 * u) *
                                        std::sin(2.0 * std::numbers::pi * 128.0 * v);
        const double wear = fractal_noise({u, v}, 4, 4, seed);
        Texel t;
        t.color =
            glm::dvec3(0.74 + 0.22 * std::max(flower, 0.7 * ring) - 0.05 * thread + 0.04 * wear);
        return t;
    });
}

SurfaceImages leaf_images(std::uint32_t seed) {
    return bake({.name = "leaf", .size = 256, .metres = 0.2}, [seed](double u, double v) {
        const double mottle = fractal_noise({u, v}, 4, 5, seed);
        Texel t;
        t.color = glm::mix(glm::dvec3(0.20, 0.34, 0.13), glm::dvec3(0.45, 0.56, 0.24),
                           glm::smoothstep(-0.5, 0.5, mottle));
        return t;
    });
}

SurfaceImages water_images(std::uint32_t seed) {
    const BakeOptions options{.name = "water", .metres = 2.0, .base_color = false, .normal = true};
    return bake(options, [seed](double u, double v) {
        Texel t;
        t.height = 0.010 * fractal_noise({u, v}, 7, 2, seed) +
                   0.004 * fractal_noise({v, u}, 19, 2, seed + 1u);
        return t;
    });
}

}  // namespace kilolux
