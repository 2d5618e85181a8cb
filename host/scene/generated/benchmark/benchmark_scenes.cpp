// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/benchmark/benchmark_scenes.h"

#include "host/scene/generated/atrium/atrium.h"
#include "host/scene/generated/benchmark/block_field.h"
#include "host/scene/generated/benchmark/lantern_forest.h"
#include "host/scene/generated/benchmark/metal_hall.h"
#include "host/scene/generated/benchmark/panel_wall.h"
#include "host/scene/generated/benchmark/street.h"

namespace kilolux {
namespace {

Scene make_benchmark_atrium() { return make_atrium(1); }

constexpr LightOptions kNoPoints{.count = 0, .box = {}};

const BenchmarkScene kBenchmarkScenes[] = {
    {"atrium", "a columned hall with textures and normal maps; 1000 points", make_benchmark_atrium,
     LightOptions{.count = 1000, .box = {}}},
    {"metal_hall", "rough metals, microfacet lobes; 500 points", make_metal_hall,
     LightOptions{.count = 500, .seed = 2, .radius = 3.5, .box = {}}},
    {"street", "a street by night, Lambertian; spots", make_street, kNoPoints},
    {"lantern_forest", "trees, Lambertian; 3000 points of short range", make_lantern_forest,
     kNoPoints},
    // No shadows: no bound is known for the error of those of lights with a size.
    {.name = "panel_wall",
     .about = "a wall of 96 rectangular lights, Lambertian and rough surfaces",
     .make = make_panel_wall,
     .generated_lights = kNoPoints,
     .reference_count = 2},
    {.name = "million",
     .about = "blocks on a plain, Lambertian; a million points by a formula",
     .make = make_block_field,
     .generated_lights = LightOptions{.count = 1'000'000, .seed = 6, .radius = 2.0, .box = {}},
     .by_formula = true,
     .width = 48,
     .height = 27,
     .reference_count = 1},
};

constexpr BenchmarkReference kBenchmarkReferences[] = {
    {"range"},
    {"inverse_square", true},
    {"inverse_square_shadows", true, true},
};

}  // namespace

std::span<const BenchmarkScene> benchmark_scenes() { return kBenchmarkScenes; }

std::span<const BenchmarkReference> benchmark_references() { return kBenchmarkReferences; }

}  // namespace kilolux
