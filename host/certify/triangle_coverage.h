// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "host/gpu/device.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Vertices, and triangles by their numbers.
struct TriangleMesh {
    std::vector<glm::vec3> vertices;
    std::vector<std::array<int, 3>> triangles;
};

/// Each triangle as a mesh of its own, double-sided, all with one transform.
Scene scene_of_triangles(const TriangleMesh& mesh,
                         const glm::dmat4& world_from_object = glm::dmat4(1.0));

/// How many of a scene_of_triangles()' triangles cover each pixel, hidden or not. Draws them one by
/// one.
std::vector<int> triangle_coverage(const Gpu& gpu, const Scene& scene, const Camera& camera,
                                   int width, int height);

/// A closed body about the origin whose vertices are 0.7 to 1.5 away.
TriangleMesh random_body(std::uint32_t seed);

/// A fan about `centre` whose rim, 100 away, lies on halves: in the plane z = 0.
TriangleMesh fan(const glm::vec2& centre, int spokes);

}  // namespace kilolux
