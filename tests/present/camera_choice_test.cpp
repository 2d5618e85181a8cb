// SPDX-License-Identifier: Apache-2.0
#include "present/cli/camera_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/messages.h"

namespace kilolux {
namespace {

// A box from -1 to 1, seen by `cameras` cameras at x = 10, 20, ... that look down -Z.
Scene make_scene(int cameras) {
    Scene scene;
    scene.name = "box";
    Mesh mesh;
    mesh.positions = {{-1, -1, -1}, {1, 1, 1}, {1, -1, 1}};
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, glm::dmat4(1.0)});
    for (int i = 1; i <= cameras; ++i) {
        SceneCamera camera;
        camera.world_from_camera[3] = glm::dvec4(10.0 * i, 0, 0, 1);
        camera.y_fov = 0.1 * i;
        scene.cameras.push_back(camera);
    }
    return scene;
}

glm::dvec3 forward(const Camera& camera) { return -camera.world_from_view[2]; }

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

// A camera for pictures of 4:3 keeps its width in a narrow picture, and its height in a wide one.
TEST(CameraChoice, ByDefaultNothingOfAFilesCameraIsCutOff) {
    Scene scene = make_scene(1);
    scene.cameras[0].aspect = 4.0 / 3.0;
    const double made_for = scene.cameras[0].y_fov;
    EXPECT_NEAR(choose_camera({}, scene, 16.0 / 9.0).y_fov, made_for, 1e-12);
    const double narrow = choose_camera({}, scene, 120.0 / 160.0).y_fov;
    EXPECT_NEAR(std::tan(0.5 * narrow) * 0.75, std::tan(0.5 * made_for) * 4.0 / 3.0, 1e-12);
}

TEST(CameraChoice, TheFirstOfTheSceneElseTheFramingOne) {
    expect_near(choose_camera({}, make_scene(2)).position, {10, 0, 0});
    const Camera framed = choose_camera({}, make_scene(0));
    expect_near(glm::normalize(-framed.position), forward(framed));
    EXPECT_GT(glm::length(framed.position), std::sqrt(3.0));
}

TEST(CameraChoice, ByIndex) {
    const Camera camera = choose_camera({.index = 1}, make_scene(2));
    expect_near(camera.position, {20, 0, 0});
    EXPECT_EQ(camera.y_fov, 0.2);
    EXPECT_EQ(message_of<UsageError>([] { choose_camera({.index = 2}, make_scene(2)); }),
              "--camera-index: 2 is no camera of box; they are 0 to 1");
    EXPECT_EQ(message_of<UsageError>([] { choose_camera({.index = 0}, make_scene(0)); }),
              "--camera-index: 0 is no camera of box; it has none");
}

TEST(CameraChoice, APositionAloneLooksAtTheMiddle) {
    const Camera camera = choose_camera({.position = glm::dvec3(0, 0, 5)}, make_scene(1));
    expect_near(camera.position, {0, 0, 5});
    expect_near(forward(camera), {0, 0, -1});
    expect_near(camera.world_from_view[1], {0, 1, 0});
    EXPECT_LE(camera.z_near, 0.01 * std::sqrt(3.0));
}

TEST(CameraChoice, EverythingGiven) {
    const CameraChoice choice{.position = glm::dvec3(1, 2, 3),
                              .focal_point = glm::dvec3(1, 2, 13),
                              .view_up = glm::dvec3(1, 0, 0),
                              .view_angle = 60.0};
    const Camera camera = choose_camera(choice, make_scene(1));
    expect_near(camera.position, {1, 2, 3});
    expect_near(forward(camera), {0, 0, 1});
    expect_near(camera.world_from_view[1], {1, 0, 0});
    EXPECT_NEAR(camera.y_fov, glm::radians(60.0), 1e-15);
}

TEST(CameraChoice, PartsKeepTheRest) {
    const Camera turned = choose_camera({.focal_point = glm::dvec3(10, 5, 0)}, make_scene(1));
    expect_near(turned.position, {10, 0, 0});
    expect_near(forward(turned), {0, 1, 0});  // along +Y, where +Y cannot be up
    const Camera wider = choose_camera({.view_angle = 90.0}, make_scene(1));
    expect_near(wider.position, {10, 0, 0});
    expect_near(forward(wider), {0, 0, -1});
    EXPECT_NEAR(wider.y_fov, glm::radians(90.0), 1e-15);
    const Camera rolled = choose_camera({.view_up = glm::dvec3(1, 0, 0)}, make_scene(1));
    expect_near(forward(rolled), {0, 0, -1});
    expect_near(rolled.world_from_view[1], {1, 0, 0});
}

TEST(CameraChoice, ParallelProjectionShowsTheWholeDepth) {
    const Camera camera =
        choose_camera({.position = glm::dvec3(0, 0, 0.5), .view_angle = 90.0, .orthographic = true},
                      make_scene(0));
    EXPECT_TRUE(camera.orthographic);
    EXPECT_NEAR(camera.y_extent, 0.5, 1e-12);
    EXPECT_LT(camera.z_near, -0.5);  // what is behind the position is seen too
    EXPECT_GT(camera.z_far, 1.5);
    EXPECT_TRUE(std::isfinite(camera.z_far));
}

TEST(CameraChoice, DegenerateDirectionsAreErrors) {
    const glm::dvec3 p(0, 0, 5);
    EXPECT_THROW(choose_camera({.position = p, .focal_point = p}, make_scene(0)), Error);
    EXPECT_THROW(choose_camera({.position = p, .view_up = glm::dvec3(0, 0, 2)}, make_scene(0)),
                 Error);
    EXPECT_THROW(choose_camera({.position = p, .view_up = glm::dvec3(0.0)}, make_scene(0)), Error);
}

}  // namespace
}  // namespace kilolux
