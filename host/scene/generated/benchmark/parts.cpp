// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/benchmark/parts.h"

#include "host/scene/generated/small.h"
#include "kernels/shared/hash.h"

namespace kilolux {

int add_matte(Scene& scene, const char* name, const glm::vec3& color) {
    const int material = add_diffuse(scene, name, color);
    scene.materials.back().specular = 0.0f;
    return material;
}

double benchmark_random(std::uint64_t seed, std::uint64_t item, std::uint64_t stream) {
    return unit_double(item_bits(item_key(seed, item), stream));
}

}  // namespace kilolux
