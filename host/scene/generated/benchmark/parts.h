// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/scene.h"

namespace kilolux {

/// Appends a material that is Lambertian: no specular part. Returns its index.
int add_matte(Scene& scene, const char* name, const glm::vec3& color);

/// In [0, 1): number `stream` of an item of a scene's seed.
double benchmark_random(std::uint64_t seed, std::uint64_t item, std::uint64_t stream);

}  // namespace kilolux
