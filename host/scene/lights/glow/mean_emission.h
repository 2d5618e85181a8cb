// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace kilolux {

/// What a triangle emits, averaged over its area.
struct MeanEmission {
    glm::dvec3 radiance{0.0};  // [nit], linear Rec. 709, times the share that the surface covers
    double variance = 0.0;     // within the triangle, summed over the channels [nit^2]
    bool operator==(const MeanEmission&) const = default;
};

/// Whether surfaces of the material light others: they emit and are not unlit.
bool glows(const Material& material);

/// Whether the emission varies over the mesh: by a map, or by what alphaMode MASK or BLEND leaves.
bool has_varied_emission(const Material& material);

/// Most points at which one triangle's emission is read.
inline constexpr std::size_t kMostEmissionPoints = 65536;

/// The mean over the triangle `number` of the mesh: emissive factor times map times coverage, which
/// is 0 or 1 with alphaMode MASK and alpha with BLEND. Maps are read as the renderer reads them,
/// but at their finest level, at a random point in each cell of an even grid, so that no pattern of
/// the map can hide from it: along each side at least 32 points and eight a texel, or fewer where
/// these would be more than `most_points`. For a straight edge through the triangle the mean errs
/// by 0.3 % with 32 x 32 points.
MeanEmission mean_emission(const Scene& scene, const Mesh& mesh, const Material& material,
                           std::size_t number, std::size_t most_points = kMostEmissionPoints);

}  // namespace kilolux
