// SPDX-License-Identifier: Apache-2.0
// The reference has whatever changes the light of a frame, so that what is left is rounding.
#include "host/measure/reference/frame_error.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// Relative, as of report's kernels; no shadow's edge moves at this size.
constexpr double kRounding = 3e-5;

double largest_error(const Scene& scene, const RenderSettings& settings) {
    Renderer renderer(scene, settings);
    const FrameError error = measure_frame_error(renderer, settings, first_camera(scene), 0.0);
    return error.kernels.value().hdr.relative.max;
}

TEST(FrameError, TheReferenceHasShadows) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = small_settings(64, 36, 40);
    settings.shadows = Shadows::exact;
    EXPECT_LT(largest_error(scene, settings), kRounding);
}

TEST(FrameError, TheReferenceDrawsRanges) {
    Scene scene = grid_with_every_light();
    for (SceneLight& light : scene.lights) {
        light.range = 0.0f;
        light.intensity *= 0.02f;
    }
    RenderSettings settings = small_settings(64, 36, 0);
    settings.tails = Tails::stochastic;
    EXPECT_LT(largest_error(scene, settings), kRounding);
}

// Of a small scene it stops growing nearer than by default.
TEST(FrameError, TheReferenceLimitsTheInverseSquareWhereTheFrameDoes) {
    Scene scene = make_generated_scene("grid");
    constexpr double kScale = 1e-4;
    for (Instance& instance : scene.instances) {
        instance.world_from_object =
            glm::scale(glm::dmat4(1.0), glm::dvec3(kScale)) * instance.world_from_object;
    }
    scene.cameras.clear();
    EXPECT_LT(largest_error(scene, small_settings(64, 36, 40)), kRounding);
}

}  // namespace
}  // namespace kilolux
