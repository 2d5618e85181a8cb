// SPDX-License-Identifier: Apache-2.0
// Scenes for the cases that render through OpenGL and OpenCL.
#pragma once

#include "host/gpu/device.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Settings for a picture by `gpu` at its lane width, without generated lights.
RenderSettings scene_settings(const Gpu& gpu, int width, int height);

/// Adds a quad in the plane z = 0: `corner` is its lower left, 1 m its height.
void add_quad(Mesh& mesh, const glm::vec2& corner, float width, const glm::vec3& normal);

/// One instance of the mesh with the default material.
Scene quad_scene(Mesh mesh);

/// An orthographic camera that shows the quads from (0, 0) to (width, height).
Camera quad_camera(int width, int height);

}  // namespace kilolux
