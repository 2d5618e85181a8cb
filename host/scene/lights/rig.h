// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Lights that are added to a scene's own.
enum class Rig { automatic, none, swarm, studio, headlight };

/// The rig that `automatic` stands for: `none` for scenes with lights of their own, `swarm` for an
/// interior and for a scene that the program generated, else `studio`.
Rig automatic_rig(const Scene& scene, bool is_generated);

/// Share of the scene's surface that is metal, 0 to 1: few lights cannot show it.
double metallic_share(const Scene& scene);

/// The lights of a rig, all of them directional, so that they suit a scene of any size.
///
///   studio     key from the upper left of +Z, the front of a glTF model; fill from the right, rim
///              from behind, less from above and from the floor; and a soft surround, rig_ambient()
///   headlight  one that travels as the camera looks
///   others     none: a swarm's lights are those of light_generator.h
///
/// A surface of albedo 0.5 that faces the front of a studio has a radiance of about 0.35.
std::vector<SceneLight> rig_lights(Rig rig);

/// Radiance from everywhere that belongs to the rig; `standard` where it has none of its own.
float rig_ambient(Rig rig, float standard);

/// A light in camera space (SceneLight::follows_camera) as a light in the world; others unchanged.
SceneLight placed_light(SceneLight light, const glm::dmat3& world_from_view,
                        const glm::dvec3& camera_position);

}  // namespace kilolux
