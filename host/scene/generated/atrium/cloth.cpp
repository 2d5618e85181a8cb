// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/pieces.h"

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
