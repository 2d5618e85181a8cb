// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/base/scene_features.h"
#include "host/scene/scene.h"
#include "kernels/shared/area/area_shape.h"
#include "kernels/shared/light.h"
#include "kernels/shared/light_profile.h"

namespace kilolux {

/// Lights relative to a camera, in the rows that kernels take.
struct LightRows {
    std::vector<Light> local;  // all but directional lights
    std::vector<DirectionalLight> directional;
    std::vector<AimedProfile> profiles;     // one per local light, or none at all; world axes
    std::vector<LightShape> shapes;         // likewise
    std::span<const float> profile_tables;  // that they are of; the light source's
    std::uint64_t rejected = 0;  // not finite, no range, or no light: counted, never silently lost
    SceneFeatures features;      // the kinds of lights alone
};

/// Whether a light can be used from this camera position: finite, with a range, and giving light.
bool is_usable(const SceneLight& light, const glm::dvec3& camera_position);

/// A light with a position that is_usable(), in the world: MoveLights makes its row.
WorldLight world_light(const SceneLight& light);

/// The photometric web of a light of the scene, world axes. `starts`: of the tables of its webs.
AimedProfile aimed_profile(const SceneLight& light, const Scene& scene,
                           std::span<const float> starts);

/// The shape of a light that is_usable(), world axes; zeros for one without a size.
LightShape shape_row(const SceneLight& light);

/// A directional light's row, world axes.
DirectionalLight directional_row(const SceneLight& light);

/// Positions meet the camera in double, so that a scene far from the origin keeps float32's
/// accuracy about the camera: 1e6 m away, float32 world positions would be 6 cm apart. A light that
/// cannot be used is left out and counted; the others are unaffected. Lights without a range must
/// have got one (fill_missing_ranges).
LightRows make_light_rows(std::span<const SceneLight> lights, const glm::dvec3& camera_position);

}  // namespace kilolux
