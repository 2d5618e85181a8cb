// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/benchmark/lantern_forest.h"

#include <cmath>
#include <numbers>

#include "host/scene/generated/benchmark/parts.h"
#include "host/scene/generated/small.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kForestSeed = 4;
constexpr int kForestTrees = 250;
constexpr int kTreeLanterns = 12;     // of a tree
constexpr double kCrown = 1.5;        // [m], radius; lanterns hang beside it
constexpr double kForestEdge = 40.0;  // [m], half of the ground
constexpr double kClearing = 2.5;     // [m], half of the path along Z
constexpr float kLanternRange = 3;    // [m]

// Beside the path.
glm::dvec3 tree_place(std::uint64_t tree) {
    const double across = 2.0 * benchmark_random(kForestSeed, tree, 0) - 1.0;
    const double along = 2.0 * benchmark_random(kForestSeed, tree, 1) - 1.0;
    const double x =
        std::copysign(kClearing + (kForestEdge - kClearing - 2.0) * std::abs(across), across);
    return {x, 0.0, (kForestEdge - 2.0) * along};
}

void hang_lanterns(Scene& scene, std::uint64_t tree, const glm::dvec3& at) {
    for (std::uint64_t i = 0; i < kTreeLanterns; ++i) {
        const std::uint64_t item = kForestTrees + tree * kTreeLanterns + i;
        const auto random = [item](std::uint64_t k) {
            return benchmark_random(kForestSeed, item, k);
        };
        const double turn = 2.0 * std::numbers::pi * random(0);
        const double out = kCrown + 0.1 + 0.6 * random(1);
        SceneLight& light = scene.lights.emplace_back();
        light.position =
            at + glm::dvec3(out * std::cos(turn), 0.5 + 6.0 * random(2), out * std::sin(turn));
        const auto warm = static_cast<float>(random(3));
        light.intensity = 1.4f * glm::vec3(1.0f, 0.4f + 0.4f * warm, 0.12f + 0.5f * warm * warm);
        light.range = kLanternRange;
    }
}

}  // namespace

Scene make_lantern_forest() {
    Scene scene;
    scene.name = "lantern_forest";
    MeshBuilder ground, trunk;
    ground.level({-kForestEdge, -kForestEdge}, {kForestEdge, kForestEdge}, 0.0);
    trunk.lathe({{Point2(0.3, 0.0), Point2(0.18, 4.0)}, 0.6}, 16);
    place(scene, add_bare(scene, "ground", ground, add_matte(scene, "moss", {0.2f, 0.28f, 0.12f})));
    const int trunks =
        add_bare(scene, "trunk", trunk, add_matte(scene, "bark", {0.35f, 0.26f, 0.2f}));
    const int crowns = add_bare(scene, "crown", ball(kCrown, 24),
                                add_matte(scene, "leaves", {0.16f, 0.36f, 0.14f}));
    for (std::uint64_t tree = 0; tree < kForestTrees; ++tree) {
        const glm::dvec3 at = tree_place(tree);
        place(scene, trunks, placed(at));
        place(scene, crowns, placed(at + glm::dvec3(0.0, 5.2, 0.0)));
        hang_lanterns(scene, tree, at);
    }
    scene.cameras = {camera_from_to("path", {0.4, 1.7, 36.0}, {-1.0, 2.0, 0.0}, 55.0),
                     camera_from_to("above", {-18.0, 11.0, 30.0}, {2.0, 1.0, -2.0}, 50.0)};
    return scene;
}

}  // namespace kilolux
