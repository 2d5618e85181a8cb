// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/textures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/noise.h"

namespace kilolux {
namespace {

// 1 on the zero lines of a noise, falling off at both sides.
double vein(double noise, double sharpness) {
    return std::pow(std::max(1.0 - std::abs(noise), 0.0), sharpness);
}

// The stone that holds a point of the texture.
struct Stone {
    int column;
    int row;
    double edge;        // [share of the texture] to the nearest joint
    glm::dvec2 inside;  // -0.5..0.5 across the stone
};

int floor_int(double x) { return static_cast<int>(std::floor(x)); }

// Courses of equal stones, every other one shifted by half a stone.
Stone running_bond(double u, double v, int columns, int rows) {
    const int row = floor_int(v * rows);
    const double x = u * columns + 0.5 * (row % 2);
    const glm::dvec2 inside(x - std::floor(x) - 0.5, v * rows - row - 0.5);
    const double edge =
        std::min((0.5 - std::abs(inside.x)) / columns, (0.5 - std::abs(inside.y)) / rows);
    return {floor_int(x) % columns, row, edge, inside};
}

// Courses of `columns` stones whose joints are shifted at random by up to a third of a stone.
Stone uneven_courses(double u, double v, int columns, int rows, std::uint32_t seed) {
    const int row = floor_int(v * rows);
    const double x = u * columns + lattice_value(row, 77, rows, seed);
    const auto joint = [&](int i) {
        return i + 0.66 * (lattice_value(((i % columns) + columns) % columns, row, 64, seed) - 0.5);
    };
    int column = floor_int(x);
    if (x < joint(column)) --column;
    if (x >= joint(column + 1)) ++column;
    const double low = joint(column);
    const double high = joint(column + 1);
    const glm::dvec2 inside((x - low) / (high - low) - 0.5, v * rows - row - 0.5);
    const double edge =
        std::min(std::min(x - low, high - x) / columns, (0.5 - std::abs(inside.y)) / rows);
    return {((column % columns) + columns) % columns, row, edge, inside};
}

Texel blend(const Texel& a, const Texel& b, double t) {
    return {glm::mix(a.color, b.color, t), a.height + (b.height - a.height) * t,
            a.roughness + (b.roughness - a.roughness) * t};
}

// 1 within `joint` of the joint's middle, 0 on the stone; distances in shares of the texture.
double joint_share(double edge, double joint, double bevel) {
    return 1.0 - glm::smoothstep(joint, joint + bevel, edge);
}

Texel octagon_or_dot(double u, double v, std::uint32_t seed) {
    const glm::dvec2 cell = glm::dvec2(u, v) * 4.0;
    const glm::dvec2 in = cell - glm::floor(cell) - 0.5;
    const glm::dvec2 from_corner = 0.5 - glm::abs(in);
    constexpr double kDot = 0.30;  // half diagonal of the dots, in tiles
    const double to_dot = from_corner.x + from_corner.y - kDot;
    const bool dot = to_dot < 0.0;
    const double edge =
        dot ? -to_dot * 0.7 : std::min({from_corner.x, from_corner.y, to_dot * 0.7});
    const int column = floor_int(dot ? cell.x + 0.5 : cell.x) % 4;
    const int row = floor_int(dot ? cell.y + 0.5 : cell.y) % 4;
    const double tone = lattice_value(column, row, 4, seed + (dot ? 9u : 5u));
    const bool red = (column + row) % 2 == 0;
    const glm::dvec3 plain = red ? glm::dvec3(0.62, 0.36, 0.29) : glm::dvec3(0.86, 0.80, 0.69);
    const double cloud = fractal_noise({u, v}, 6, 5, seed + 31u);
    const double vein = std::pow(1.0 - std::abs(fractal_noise({v, u}, 5, 4, seed + 3u)), 14.0);
    Texel stone;
    stone.color =
        (dot ? glm::dvec3(0.20, 0.24, 0.24) : plain) * (0.93 + 0.14 * tone + 0.10 * cloud);
    stone.color = glm::mix(stone.color, glm::dvec3(0.92, 0.90, 0.86), dot ? 0.0 : 0.25 * vein);
    // Each tile is tilted a little, so that highlights break at the joints.
    stone.height = 0.0012 * ((tone - 0.5) * in.x + (0.5 - tone * tone) * in.y) + 0.00006 * cloud;
    stone.roughness = 0.24 + 0.12 * tone + 0.08 * std::abs(cloud);
    const Texel grout{{0.47, 0.43, 0.38}, -0.0025, 0.85};
    return blend(stone, grout, joint_share(edge, 0.010, 0.012));
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

SurfaceImages brick_images(std::uint32_t seed) {
    BakeOptions options{.name = "brick", .metres = 1.6, .normal = true, .roughness = true};
    return bake(options, [seed](double u, double v) {
        const double wobble = 0.0006 * fractal_noise({u, v}, 16, 3, seed + 5u);
        const Stone s = running_bond(u, v, 8, 20);
        const double tone = lattice_value(s.column, s.row, 40, seed);
        const double dark = lattice_value(s.column, s.row, 40, seed + 1u);
        const double grain = fractal_noise({u, v}, 24, 4, seed + 2u);
        Texel brick;
        brick.color = glm::mix(glm::dvec3(0.60, 0.34, 0.25), glm::dvec3(0.74, 0.47, 0.34), tone);
        brick.color *= (dark > 0.86 ? 0.72 : 1.0) * (1.0 + 0.16 * grain);
        brick.height = 0.002 * (tone - 0.5) + 0.0012 * grain + 0.004 * (dark - 0.5) * s.inside.y;
        brick.roughness = 0.78 + 0.12 * grain;
        Texel mortar{{0.72, 0.68, 0.61}, -0.007, 0.95};
        mortar.color *= 1.0 + 0.1 * grain;
        return blend(brick, mortar, joint_share(s.edge + wobble, 0.0022, 0.0026));
    });
}

SurfaceImages tile_images(std::uint32_t seed) {
    BakeOptions options{.name = "tile", .metres = 1.6, .normal = true, .roughness = true};
    return bake(options, [seed](double u, double v) { return octagon_or_dot(u, v, seed); });
}

SurfaceImages paving_images(std::uint32_t seed) {
    BakeOptions options{.name = "paving", .metres = 3.2, .normal = true, .roughness = true};
    return bake(options, [seed](double u, double v) {
        const Stone s = uneven_courses(u, v, 5, 8, seed);
        const double tone = lattice_value(s.column, s.row, 64, seed + 1u);
        const double tilt = lattice_value(s.column, s.row, 64, seed + 2u) - 0.5;
        const double grain = fractal_noise({u, v}, 12, 6, seed + 3u);
        const double wear = fractal_noise({u, v}, 3, 4, seed + 4u);
        Texel stone;
        stone.color = glm::mix(glm::dvec3(0.58, 0.54, 0.48), glm::dvec3(0.74, 0.69, 0.60), tone);
        stone.color *= 1.0 + 0.10 * grain + 0.10 * wear;
        stone.height = 0.004 * tilt * (s.inside.x + s.inside.y) + 0.0022 * grain;
        stone.roughness = 0.62 + 0.15 * grain - 0.12 * wear;
        const Texel joint{{0.36, 0.33, 0.28}, -0.009, 0.95};
        return blend(stone, joint, joint_share(s.edge + 0.0010 * grain, 0.0018, 0.0032));
    });
}

SurfaceImages voussoir_images(std::uint32_t seed) {
    return bake({.name = "voussoir", .metres = 2.0}, [seed](double u, double v) {
        const double x = u * 8.0;
        const int wedge = floor_int(x);
        const double edge = 0.5 - std::abs(x - wedge - 0.5);
        const double grain = fractal_noise({u, v}, 12, 5, seed);
        const double tone = lattice_value(wedge, 0, 8, seed + 1u);
        Texel t;
        t.color = wedge % 2 == 0 ? glm::dvec3(0.66, 0.31, 0.24) : glm::dvec3(0.85, 0.78, 0.65);
        t.color *= 0.94 + 0.1 * tone + 0.12 * grain;
        t.color *= 1.0 - 0.45 * joint_share(edge, 0.015, 0.025);
        return t;
    });
}

SurfaceImages mosaic_images(std::uint32_t seed) {
    return bake({.name = "mosaic", .metres = 0.8}, [seed](double u, double v) {
        constexpr int kPieces = 40;
        const Stone s = running_bond(u, v, kPieces, kPieces);
        const double tone = lattice_value(s.column, s.row, kPieces, seed);
        const double x = (s.column + 0.5 * (1 - s.row % 2)) / kPieces;
        const double wave = 0.1 * std::sin(2.0 * std::numbers::pi * 2.0 * x);
        const double band =
            std::fmod(4.0 * (static_cast<double>(s.row) / kPieces + 1.0 + wave), 1.0);
        Texel t;
        t.color = band < 0.45
                      ? glm::dvec3(0.12, 0.34, 0.52)
                      : (band < 0.7 ? glm::dvec3(0.24, 0.58, 0.62) : glm::dvec3(0.84, 0.84, 0.78));
        t.color *= 0.82 + 0.3 * tone;
        t.color =
            glm::mix(t.color, glm::dvec3(0.45, 0.44, 0.40), joint_share(s.edge, 0.0012, 0.0014));
        return t;
    });
}

}  // namespace kilolux
