// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "host/scene/lights/glow/mean_emission.h"
#include "host/scene/scene.h"

namespace kilolux {

/// An instance of a mesh with a glowing material.
struct GlowingInstance {
    const Mesh& mesh;
    const Material& material;
    std::span<const MeanEmission> emission;  // by triangle; empty: the same everywhere
    const glm::dmat4& world_from_object;
};

/// The lights of an instance, and what they stand for.
struct TriangleLights {
    std::vector<SceneLight> lights;
    std::size_t triangles = 0, rectangles = 0, left_out = 0, varied = 0;
    // Over triangles whose emission varies: relative variance times area, and area [m^2].
    double squares = 0.0, varied_area = 0.0;
};

/// See GlowingSurfaces.
TriangleLights make_triangle_lights(const GlowingInstance& instance);

/// What make_triangle_lights() takes in memory for each triangle meanwhile, at most.
inline constexpr std::size_t kBytesPerGlowingTriangle = 256 + 2 * sizeof(SceneLight);

}  // namespace kilolux
