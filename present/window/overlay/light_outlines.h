// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "present/window/overlay/cluster_overlay.h"

namespace kilolux {

/// Most outlines that are drawn at once.
inline constexpr std::size_t kMostOutlines = 1000;

/// The closed outline of a light as the camera sees it, its points in order, world [m]: corners, an
/// ellipse, of a sphere its silhouette. Empty without a size, and for a sphere around the camera.
std::vector<glm::dvec3> outline_of(const SceneLight& light, const Camera& camera);

/// Numbers of the lights with a size; the nearest to the camera, in no order, if there are more
/// than `most`.
std::vector<std::size_t> nearest_area_lights(std::span<const SceneLight> lights,
                                             const Camera& camera, std::size_t most);

/// Draws outlines over the picture, whatever hides the lights: of the state's selected one of
/// `lights`, with the way that it shines, and of all with a size where the state says so. One
/// without a size is a circle.
void draw_light_outlines(ImDrawList& draw, std::span<const SceneLight> lights,
                         const ViewState& state, const ShownPicture& picture);

}  // namespace kilolux
