// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/benchmark/block_field.h"

#include "host/scene/generated/benchmark/parts.h"
#include "host/scene/generated/small.h"

namespace kilolux {

Scene make_block_field() {
    constexpr std::uint64_t kFieldSeed = 6;
    constexpr std::uint64_t kFieldBlocks = 600;
    constexpr double kFieldEdge = 100.0;  // [m], half of the plain
    Scene scene;
    scene.name = "million";
    MeshBuilder ground, blocks;
    ground.level({-kFieldEdge, -kFieldEdge}, {kFieldEdge, kFieldEdge}, 0.0);
    for (std::uint64_t i = 0; i < kFieldBlocks; ++i) {
        const auto random = [i](std::uint64_t k) { return benchmark_random(kFieldSeed, i, k); };
        const glm::dvec3 half(0.4 + 1.2 * random(0), 0.0, 0.4 + 1.2 * random(1));
        const double place = kFieldEdge - 2.0;
        const glm::dvec3 at(place * (2.0 * random(2) - 1.0), 0.0, place * (2.0 * random(3) - 1.0));
        blocks.box(at - half, at + half + glm::dvec3(0.0, 0.5 + 3.0 * random(4), 0.0));
    }
    place(scene, add_bare(scene, "ground", ground, add_matte(scene, "sand", glm::vec3(0.5f))));
    place(scene,
          add_bare(scene, "blocks", blocks, add_matte(scene, "stone", {0.45f, 0.5f, 0.55f})));
    scene.cameras = {camera_from_to("over", {4.0, 6.0, 62.0}, {0.0, 0.5, 46.0}, 50.0)};
    scene.light_box = {{-kFieldEdge, 0.05, -kFieldEdge}, {kFieldEdge, 4.0, kFieldEdge}};
    return scene;
}

}  // namespace kilolux
