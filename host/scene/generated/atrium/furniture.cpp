// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/furniture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

// Half width of a tied curtain at a share `down` of its height: wide at the rod, narrow at the tie,
// a little wider at the hem.
double curtain_spread(double down) {
    constexpr double kTie = 0.60;
    if (down < kTie) {
        const double t = down / kTie;
        return 0.95 - 0.80 * t * t * (1.6 - 0.6 * t);
    }
    const double t = (down - kTie) / (1.0 - kTie);
    return 0.15 + 0.22 * t * (2.0 - t);
}

}  // namespace

MeshBuilder urn() {
    MeshBuilder builder;
    builder.box({-0.20, 0.0, -0.20}, {0.20, 0.10, 0.20});
    builder.lathe({{Point2(0.17, 0.10), Point2(0.17, 0.13), Point2(0.09, 0.19), Point2(0.07, 0.24),
                    Point2(0.10, 0.27), Point2(0.22, 0.36), Point2(0.30, 0.48), Point2(0.32, 0.60),
                    Point2(0.29, 0.70), Point2(0.20, 0.78), Point2(0.17, 0.82), Point2(0.19, 0.88),
                    Point2(0.26, 0.93), Point2(0.26, 0.95), Point2(0.21, 0.95), Point2(0.15, 0.84),
                    Point2(0.0, 0.80)},
                   0.75},
                  18);
    for (const double side : {-1.0, 1.0}) {
        std::vector<glm::dvec3> handle;
        for (int i = 0; i <= 8; ++i) {
            const double t = std::numbers::pi * i / 8;
            handle.emplace_back(side * (0.24 + 0.16 * std::sin(t)), 0.74 + 0.15 * std::cos(t), 0.0);
        }
        builder.tube(handle, 0.022, 6);
    }
    return builder;
}

MeshBuilder bench() {
    MeshBuilder builder;
    builder.box({-0.85, 0.40, -0.25}, {0.85, 0.48, 0.25});
    builder.box({-0.80, 0.35, -0.21}, {0.80, 0.40, 0.21});
    for (const double x : {-0.62, 0.62}) {
        builder.box({x - 0.10, 0.0, -0.22}, {x + 0.10, 0.06, 0.22});
        builder.box({x - 0.07, 0.06, -0.17}, {x + 0.07, 0.29, 0.17});
        builder.box({x - 0.10, 0.29, -0.21}, {x + 0.10, 0.35, 0.21});
    }
    return builder;
}

MeshBuilder pot() {
    MeshBuilder builder;
    builder.lathe({{Point2(0.26, 0.0), Point2(0.28, 0.04), Point2(0.27, 0.07), Point2(0.34, 0.26),
                    Point2(0.39, 0.46), Point2(0.40, 0.52), Point2(0.45, 0.54), Point2(0.46, 0.60),
                    Point2(0.44, 0.62), Point2(0.39, 0.62), Point2(0.37, 0.55), Point2(0.0, 0.56)},
                   0.6},
                  28);
    return builder;
}

MeshBuilder tree_trunk(double bottom) {
    MeshBuilder builder;
    const glm::dvec3 trunk[5] = {
        {0, bottom, 0}, {0.02, 0.9, 0.01}, {-0.01, 1.25, 0.03}, {0.01, 1.6, 0.0}, {0, 1.95, 0}};
    builder.tube(trunk, 0.055, 8);
    for (int i = 0; i < 5; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 5;
        const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
        const glm::dvec3 branch[3] = {glm::dvec3(0, 1.35 + 0.05 * i, 0),
                                      glm::dvec3(0, 1.62, 0) + 0.2 * out,
                                      glm::dvec3(0, 1.9, 0) + 0.45 * out};
        builder.tube(branch, 0.025, 5);
    }
    return builder;
}

MeshBuilder foliage(double height, double radius, int leaves, std::uint64_t seed) {
    MeshBuilder builder;
    for (int i = 0; i < leaves; ++i) {
        const std::uint64_t key = item_key(seed, static_cast<std::uint64_t>(i));
        const auto random = [key](std::uint64_t s) { return unit_double(item_bits(key, s)); };
        const double y = 2.0 * random(0) - 1.0;
        const double angle = 2.0 * std::numbers::pi * random(1);
        const double ring = std::sqrt(1.0 - y * y);
        const glm::dvec3 out(ring * std::cos(angle), y, ring * std::sin(angle));
        const double r = radius * (0.55 + 0.45 * std::sqrt(random(2)));
        // The leaf faces roughly outwards and hangs a little.
        const glm::dvec3 tilt(random(3) - 0.5, 0.55, random(4) - 0.5);
        const glm::dvec3 n = glm::normalize(out + 0.7 * tilt);
        const glm::dvec3 along =
            glm::normalize(glm::cross(n, glm::dvec3(random(5) - 0.5, random(6) - 0.5, 0.3)));
        const glm::dvec3 side = glm::cross(n, along);
        const double length = 0.11 + 0.05 * random(7);
        const glm::dvec3 base = glm::dvec3(0, height, 0) + r * out;
        builder.patch(2, 2, [&](double u, double v) {
            const double across = 2.0 * u - 1.0;
            const double half = 0.30 * length * (v < 0.25 ? 0.35 : (v < 0.75 ? 1.0 : 0.12));
            const glm::dvec3 p = base + v * length * along + across * half * side +
                                 n * (0.15 * length * (std::abs(across) - v * v));
            return SurfacePoint{
                p, n + 0.5 * across * -side, {across * half + 0.1 * random(8), v * length}};
        });
    }
    return builder;
}

MeshBuilder lantern_iron(double chain) {
    MeshBuilder builder;
    const glm::dvec3 rod[2] = {{0, 0, 0}, {0, 0.12 - chain, 0}};
    builder.tube(rod, 0.008, 5);
    MeshBuilder cage;
    cage.lathe({{Point2(0.0, -0.50), Point2(0.03, -0.47), Point2(0.05, -0.44), Point2(0.13, -0.42),
                 Point2(0.14, -0.39), Point2(0.125, -0.38)},
                0.6},
               6);
    cage.lathe({{Point2(0.15, -0.02), Point2(0.17, -0.01), Point2(0.17, 0.01), Point2(0.10, 0.07),
                 Point2(0.04, 0.10), Point2(0.03, 0.14), Point2(0.0, 0.15)},
                0.6},
               6);
    for (int i = 0; i < 6; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 6;
        const glm::dvec3 out(std::cos(angle), 0.0, -std::sin(angle));
        const glm::dvec3 bar[2] = {0.125 * out + glm::dvec3(0, -0.39, 0),
                                   0.155 * out + glm::dvec3(0, 0.0, 0)};
        cage.tube(bar, 0.011, 4);
    }
    builder.append(cage, placed({0.0, -chain, 0.0}));
    return builder;
}

MeshBuilder lantern_glass(double chain) {
    MeshBuilder builder;
    builder.lathe({{{0.118, -0.38}, {0.146, -0.01}}, 0.3}, 6, {0.0, -chain, 0.0});
    return builder;
}

MeshBuilder banner() {
    MeshBuilder builder;
    constexpr double kHalf = 0.55;
    constexpr double kLength = 2.3;
    // Seen from -z, u runs to -x.
    builder.smooth_patch(
        14, 10,
        [](double u, double v) {
            const double across = 1.0 - 2.0 * u;
            const double down = 1.0 - v;
            const double fold = 0.05 * down * std::sin(3.0 * std::numbers::pi * across + 0.8) +
                                0.03 * down * down * std::sin(1.3 * std::numbers::pi * across);
            // The lower edge is a swallow's tail.
            const double tail = 1.0 - 0.14 * (1.0 - std::abs(across)) * down * down;
            return glm::dvec3(kHalf * across * (1.0 - 0.06 * down), -kLength * down * tail, -fold);
        },
        {2.0 * kHalf, kLength});
    const glm::dvec3 rod[2] = {{-0.64, 0.0, 0.0}, {0.64, 0.0, 0.0}};
    builder.tube(rod, 0.022, 6);
    return builder;
}

MeshBuilder curtain() {
    MeshBuilder builder;
    constexpr double kTop = 3.5;
    constexpr double kHem = 0.03;
    for (const double side : {-1.0, 1.0}) {
        builder.smooth_patch(
            30, 14,
            [side](double u, double v) {
                const double down = 1.0 - v;
                const double across = side > 0.0 ? u : 1.0 - u;  // 0 at the middle, 1 at the column
                const double spread = curtain_spread(down);
                const double x = 1.22 - spread * (1.0 - across);
                const double depth = 0.035 + 0.05 * std::min(down / 0.3, 1.0);
                const double fold = depth * std::sin(2.0 * std::numbers::pi * 6.0 * across) *
                                    (0.75 + 0.25 * std::sin(5.0 * across + 3.0 * down));
                return glm::dvec3(side * x, kTop + (kHem - kTop) * down, fold);
            },
            {1.2, kTop - kHem});
    }
    return builder;
}

MeshBuilder curtain_rod() {
    MeshBuilder builder;
    const glm::dvec3 rod[2] = {{-1.32, 3.52, 0.0}, {1.32, 3.52, 0.0}};
    builder.tube(rod, 0.025, 8);
    for (const double side : {-1.0, 1.0}) {
        std::vector<glm::dvec3> tie;
        for (int i = 0; i <= 16; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / 16;
            tie.emplace_back(side * (1.145 + 0.105 * std::cos(angle)),
                             1.42 + 0.02 * std::cos(angle), 0.115 * std::sin(angle));
        }
        builder.tube(tie, 0.018, 5);
    }
    return builder;
}

}  // namespace kilolux
