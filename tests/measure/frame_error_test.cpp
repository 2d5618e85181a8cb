// SPDX-License-Identifier: Apache-2.0
// The reference has whatever changes the light of a frame, so that what is left is rounding.
#include "host/measure/reference/frame_error.h"

#include <gtest/gtest.h>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// Relative, as of report's kernels; no shadow's edge moves at this size.
constexpr double kRounding = 3e-5;

double largest_error(const Scene& scene, const RenderSettings& settings) {
    Renderer renderer(scene, settings);
    Camera camera = first_camera(scene);
    camera.z_near = 1e-3 * glm::length(bounds(scene).size());
    const FrameError error = measure_frame_error(renderer, settings, camera, 0.0);
    EXPECT_GT(error.lights_per_pixel, 1.0);
    return error.kernels.value().hdr.relative.max;
}

TEST(FrameError, TheReferenceHasShadows) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = small_settings(64, 36, 40);
    settings.shadows = Shadows::exact;
    EXPECT_LT(largest_error(scene, settings), kRounding);
}

// A light is weighed by the chance that its range was drawn to reach so far.
TEST(FrameError, TheReferenceHasDrawnRanges) {
    Scene scene = grid_with_every_light();
    for (SceneLight& light : scene.lights) {
        light.range = 0.0f;
        light.intensity *= 0.03f;  // bounded ranges that end within the scene
        light.outer_cone = 1.5f;
    }
    RenderSettings settings = small_settings(64, 36, 0);
    settings.tails = Tails::stochastic;
    EXPECT_LT(largest_error(scene, settings), kRounding);
}

}  // namespace
}  // namespace kilolux
