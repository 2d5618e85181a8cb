// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include "host/scene/generated/scenes.h"
#include "kernels/shared/hash.h"

namespace kilolux {

/// A generated scene of seed 1, made once.
inline const Scene& scene_of(const std::string& name) {
    static std::map<std::string, Scene> made;
    if (made.count(name) == 0) made[name] = make_generated_scene(name);
    return made[name];
}

/// Hash of all vertices in the world, rounded down to 0.1 mm off the round numbers that builders
/// use, so that the last bit of a library's sine does not matter.
inline std::uint64_t fingerprint(const Scene& scene) {
    std::uint64_t hash = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        for (const glm::vec3& p : mesh.positions) {
            const glm::dvec4 world = instance.world_from_object * glm::dvec4(p, 1.0);
            for (int i = 0; i < 3; ++i) {
                hash = mix64(hash + static_cast<std::uint64_t>(static_cast<std::int64_t>(
                                        std::floor(world[i] * 1e4 + 0.37))));
            }
        }
        for (const std::uint32_t index : mesh.indices) hash = mix64(hash + index);
    }
    return hash;
}

/// Hash of all pixels.
inline std::uint64_t image_fingerprint(const Scene& scene) {
    std::uint64_t hash = 0;
    for (const Image& image : scene.images) {
        for (const std::uint8_t byte : image.rgba) hash = mix64(hash + byte);
    }
    return hash;
}

}  // namespace kilolux
