// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/ray_cast_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/measure/reference/camera_rays.h"
#include "host/measure/reference/reference.h"
#include "tests/support/quad_scene.h"

namespace kilolux {
namespace {

TEST(RayCast, FlatUntexturedSurfaceIsExact) {
    const Scene scene = quad_scene();
    const Camera camera = look_at({1, 2, 5}, {0.5, 0.25, 0}, {0.1, 1, 0}, 0.9);
    const SurfaceSamples samples = RayCaster(scene).cast(camera, 33, 17);
    for (const SurfaceSample& s : samples.pixels) {
        ASSERT_EQ(s.kind, SurfaceKind::lit);
        const glm::dvec3 world = camera.position + camera.world_from_view * s.position;
        EXPECT_NEAR(world.z, 0.0, kRounding * 10);
        const glm::dvec3 normal = camera.world_from_view * s.normal;
        EXPECT_NEAR(normal.z, 1.0, kRounding);
        EXPECT_EQ(s.albedo, glm::dvec3(0.5, 0.25, 0.125));
        EXPECT_EQ(s.emissive, glm::dvec3(1, 2, 3));
        EXPECT_EQ(s.roughness, 0.75);
        EXPECT_EQ(s.metallic, 0.25);
        EXPECT_EQ(s.occlusion, 1.0);
    }
}

// Positions, projected by the camera, fall on the pixel's sample point.
TEST(RayCast, ProjectsBackToThePixelForEveryCamera) {
    const Scene scene = quad_scene(100.0f);
    for (const bool orthographic : {false, true}) {
        for (const double shift : {0.0, 0.4}) {
            Camera camera = look_at({3, -2, 4}, {0, 0, 0}, {0, 1, 0.2}, 1.0);
            camera.orthographic = orthographic;
            camera.y_extent = 3.0;
            if (orthographic) {
                camera.z_near = -20.0;
                camera.z_far = 50.0;
            }
            camera.shear = {shift, -0.5 * shift};
            camera.jitter = {shift, -0.25};
            const SurfaceSamples samples = RayCaster(scene).cast(camera, 31, 20);
            const glm::dmat4 clip = clip_from_view(camera, 31, 20);
            for (int y = 0; y < 20; ++y) {
                for (int x = 0; x < 31; ++x) {
                    const SurfaceSample& s = samples.at(x, y);
                    if (s.kind == SurfaceKind::background) continue;
                    const glm::dvec4 p = clip * glm::dvec4(s.position, 1.0);
                    // clip_from_view moves the picture by the jitter: samples land on pixel
                    // centres.
                    EXPECT_NEAR((p.x / p.w + 1) / 2 * 31, x + 0.5, 1e-12) << orthographic << shift;
                    EXPECT_NEAR((1 - p.y / p.w) / 2 * 20, y + 0.5, 1e-12) << orthographic << shift;
                }
            }
            EXPECT_EQ(samples.at(15, 10).kind, SurfaceKind::lit);
        }
    }
}

TEST(RayCast, NearAndFarCut) {
    const Scene scene = quad_scene();
    Camera camera = front_camera();
    EXPECT_EQ(center_of(scene, camera).kind, SurfaceKind::lit);
    camera.z_near = 5.001;
    EXPECT_EQ(center_of(scene, camera).kind, SurfaceKind::background);
    camera.z_near = 0.1;
    camera.z_far = 4.999;
    EXPECT_EQ(center_of(scene, camera).kind, SurfaceKind::background);
}

TEST(RayCast, ShadesLikeTheFormula) {
    Scene scene = quad_scene();
    scene.materials[0].emissive = {0, 0, 0};
    SceneLight light;
    light.position = {0, 0, 2};
    light.intensity = {8, 8, 8};
    light.range = 4.0f;
    const Camera camera = front_camera();
    const SurfaceSamples samples = RayCaster(scene).cast(camera, 3, 3);
    const ReferencePicture picture =
        shade_reference(samples, reference_lights(std::vector{light}, camera), {});
    const double expected = 0.5 / std::acos(-1.0) * 8 * (1 - 1.0 / 16) / 4;
    EXPECT_NEAR(picture.radiance.rgb[3 * 4], expected, 1e-14);
}

TEST(RayCast, EmptyScenesAreBackground) {
    for (const SurfaceSample& s : RayCaster(Scene{}).cast(front_camera(), 4, 4).pixels) {
        EXPECT_EQ(s.kind, SurfaceKind::background);
    }
}

TEST(CameraRays, StepsAreNeighboursDifferences) {
    Camera camera = front_camera();
    for (const bool orthographic : {false, true}) {
        camera.orthographic = orthographic;
        const PixelRay at = pixel_ray(camera, 7, 5, 2, 3);
        const PixelRay right = pixel_ray(camera, 7, 5, 3, 3);
        const PixelRay down = pixel_ray(camera, 7, 5, 2, 4);
        EXPECT_LT(glm::distance(at.origin + at.origin_dx, right.origin), 1e-15);
        EXPECT_LT(glm::distance(at.direction + at.direction_dx, right.direction), 1e-15);
        EXPECT_LT(glm::distance(at.origin + at.origin_dy, down.origin), 1e-15);
        EXPECT_LT(glm::distance(at.direction + at.direction_dy, down.direction), 1e-15);
    }
}

}  // namespace
}  // namespace kilolux
