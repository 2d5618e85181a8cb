// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/generated/mesh_builder.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Floor, spheres, boxes and slabs with every material feature once, a mirrored and an unevenly
/// scaled instance; a perspective and an orthographic camera.
Scene make_grid(std::uint64_t seed);

/// Floor and spheres of diffuse colours only: no texture, metal, emission or normal map.
Scene make_plain(std::uint64_t seed);

/// A hall 500 m long with a pair of pillars every 10 m, for depth range.
Scene make_corridor(std::uint64_t seed);

/// Appends a dielectric material of one colour, roughness 1; returns its index.
int add_diffuse(Scene& scene, const char* name, const glm::vec3& color);

/// Appends a mesh of positions and normals alone; returns its index.
int add_bare(Scene& scene, const char* name, const MeshBuilder& builder, int material);

/// A ball of `radius` about the origin with uv once round; poles at +y and -y.
MeshBuilder ball(double radius, int segments);

/// A camera at `from` that looks at `to`, y up.
SceneCamera camera_from_to(const char* name, const glm::dvec3& from, const glm::dvec3& to,
                           double y_fov_deg);

}  // namespace kilolux
