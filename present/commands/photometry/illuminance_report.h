// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/measure/bench/table.h"
#include "host/measure/photometry/exact_illuminance.h"
#include "host/scene/scene.h"

namespace kilolux {

/// A scene whose lights can all be used, in the world.
struct LitScene {
    Scene scene;
    std::vector<std::size_t> light_numbers;  // of its lights, among all that it was given
};

/// The illuminance of points by both ways [lx].
struct Illuminances {
    std::vector<MeasuringPoint> points;
    std::vector<double> kernels;  // of lights, by the float32 kernels
    std::vector<std::size_t>
        float64_indices;                  // numbers of the points that float64 computed, rising
    std::vector<ExactIlluminance> exact;  // of these
    std::vector<double> range_loss;       // at most, by ranges; float64's value where there is one
    std::vector<double> environment;      // apart; empty: there is none
    double ambient = 0.0;                 // apart, the same for all points

    /// float64's illuminance of point i where there is one, else null.
    const ExactIlluminance* exact_of(std::size_t i) const;
};

/// A line for each of the points [first, end): position, normal, illuminance, that of the kernels
/// and of float64, their relative difference, what ranges take away, the environment's, and the
/// three largest contributors.
Table illuminance_table(const Illuminances& result, const LitScene& lit, std::size_t first,
                        std::size_t end);

/// The document of --json and -o FILE.json: a summary, and for each point the same as its line.
nlohmann::ordered_json illuminance_json(const Illuminances& result, const LitScene& lit);

/// The summary, and the first lines of the table.
std::string illuminance_text(const Illuminances& result, const LitScene& lit);

}  // namespace kilolux
