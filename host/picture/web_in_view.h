// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/light_profile.h"

namespace kilolux {

/// A light's photometric web in view space, in double: the reference of the kernels' shares.
struct WebInView {
    const PhotometricWeb* web = nullptr;  // of the scene, which outlives this; none: an even light
    glm::dvec3 down{0, 0, -1};            // unit, vertical angle 0
    glm::dvec3 side{1, 0, 0};             // unit, vertical angle 90, horizontal angle 0
    bool mirrored = false;                // horizontal angles turn the other way
};

/// The share of the web's peak that goes along a direction of any length.
double share_towards(const WebInView& view, const glm::dvec3& direction);

/// The webs of the rows that kernels shade with. Their tables are in the order of the scene's webs.
std::vector<WebInView> webs_in_view(std::span<const AimedProfile> rows, const Scene& scene);

}  // namespace kilolux
