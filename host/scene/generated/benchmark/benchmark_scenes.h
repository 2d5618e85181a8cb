// SPDX-License-Identifier: Apache-2.0
// The scenes of `kilolux export --benchmark`: many lights of several kinds, made by code.
#pragma once

#include <span>
#include <string_view>

#include "host/scene/lights/light_generator.h"
#include "host/scene/scene.h"

namespace kilolux {

/// A row of the benchmark: a scene, its lights, and its reference pictures.
struct BenchmarkScene {
    std::string_view name;  // of its files
    std::string_view about;
    Scene (*make)();                // its cameras are the views
    LightOptions generated_lights;  // points beside the scene's own lights
    // The generated lights are too many for a file: their formula stands for them.
    bool by_formula = false;
    int width = 160;  // of the reference pictures [pixel]
    int height = 90;
    std::size_t reference_count = 3;  // of benchmark_references(), the first ones
};

/// The first row is the atrium.
std::span<const BenchmarkScene> benchmark_scenes();

/// A light model that reference pictures are made with.
struct BenchmarkReference {
    std::string_view name;        // ends the file's name
    bool inverse_square = false;  // no light has a range
    bool shadows = false;         // of every light
};

std::span<const BenchmarkReference> benchmark_references();

}  // namespace kilolux
