// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/measure/area/fit/shared_light.h"

namespace kilolux {

inline constexpr std::array kTableRoughness{0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0};
inline constexpr std::array kTableCosines{1.0, 0.8, 0.5, 0.25, 0.1, 0.03};  // n.v
inline constexpr std::array kTableSizes{0.01, 0.03, 0.1, 0.3, 1.0, 3.0};    // side / distance
inline constexpr int kTableLights = 24;

// The heading of the table that the test reads.
inline constexpr const char* kOfItself = "Rectangles: relative to the light itself";

/// Mean and largest error of the specular light of f0 = 0.04.
struct AreaError {
    double mean = 0.0, worst = 0.0;

    void add(double error, int count) {
        mean += error / count;
        if (!(error <= worst)) worst = error;  // also NaN
    }
};

struct CellErrors {
    AreaError of_itself;  // relative to the light
    AreaError of_even;    // relative to that plus the light of an even lobe of the same albedo
};

inline RoundLobe table_lobe(double roughness, double n_dot_v) {
    const double limited = std::max(roughness, 0.045);
    return {limited * limited, n_dot_v};
}

/// The errors of a cell of the table, whose lights depend on `seed`.
inline CellErrors cell_errors(AreaKind kind, const RoundLobe& lobe, double size, unsigned seed) {
    std::mt19937 random(seed);
    const LobeAlbedo albedo = albedo_of(lobe, 100);
    const double even = (0.04 * albedo.all + 0.96 * albedo.rise) / std::numbers::pi;
    CellErrors errors;
    for (int i = 0; i < kTableLights; ++i) {
        const glm::dvec3 middle = random_direction(lobe, size, i, random);
        const AreaShape shape = random_light(kind, middle, size, random);
        const auto reflected = [](glm::dvec2 light) { return 0.04 * light.x + 0.96 * light.y; };
        const double expected = reflected(lobe_integral(lobe, shape));
        const double error = std::abs(reflected(shared_integral(lobe, shape)) - expected);
        const double lambert = area_irradiance(seen(shape), false) * even;
        errors.of_itself.add(error / expected, kTableLights);
        errors.of_even.add(error / (expected + lambert), kTableLights);
    }
    return errors;
}

/// The number of a cell: its seed.
inline unsigned cell_number(std::size_t roughness, std::size_t cosine, std::size_t size) {
    return static_cast<unsigned>((roughness * kTableCosines.size() + cosine) * kTableSizes.size() +
                                 size);
}

/// "mean / worst" in percent.
inline std::string percent_pair(const AreaError& error) {
    const auto percent = [](double x) {
        char text[32];
        std::snprintf(text, sizeof text, x < 0.0995 ? "%.1f" : "%.0f", 100.0 * x);
        return std::string(text);
    };
    return percent(error.mean) + " / " + percent(error.worst);
}

}  // namespace kilolux
