// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// A scene with one point light whose shadows are known to be hard, and a camera.
struct ShadowScenario {
    std::string name;
    Scene scene;
    Camera camera;
};

/// White light from a point; `range` [m].
SceneLight lamp(const glm::dvec3& position, float range = 40.0f);

/// An empty scene with one matt, double-sided material.
Scene shadow_stage();

/// Adds a box about `center`, turned about the vertical axis.
void add_box(Scene& scene, const glm::dvec3& size, const glm::dvec3& center, double turn_rad = 0.0);

/// A row of columns before a light.
ShadowScenario columns_scenario();
/// A wall of one millimetre between a light and the floor, which it touches.
ShadowScenario thin_wall_scenario();
/// A light one millimetre above a floor of many triangles: all of it is lit.
ShadowScenario grazing_scenario();
/// Spheres over a floor, coarse and fine.
ShadowScenario spheres_scenario();
/// A sheet without thickness whose normals turn to a light behind it: it sees none of it.
ShadowScenario sheet_scenario();

/// Needles whose longest edges point at the light, within 1e-4.
ShadowScenario needles_scenario();

/// The same, moved as a whole.
ShadowScenario moved(ShadowScenario from, const glm::dvec3& by);

/// Which pixels see a scenario's light, by a renderer and by rays in double.
struct ShadowAgreement {
    int pixels = 0;     // that face the light
    int hidden = 0;     // from it, by rays in double
    int differ = 0;     // both ways
    int unfounded = 0;  // differ although no shadow's edge is within the stated distance
};

/// `settings` chooses device and size. The stated distance is 2^-15 of the distance from the light
/// and the scene's size: kernels/shadows/shadow_triangle.h.
ShadowAgreement compare_shadows(const ShadowScenario& scenario, RenderSettings settings);

}  // namespace kilolux
