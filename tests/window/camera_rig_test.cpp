// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/camera_rig.h"

#include <gtest/gtest.h>

#include <cmath>

#include "present/cli/camera_choice.h"

namespace kilolux {
namespace {

Box cube() { return {glm::dvec3(-10.0), glm::dvec3(10.0)}; }

CameraRig rig_at(const glm::dvec3& position) {
    return CameraRig(look_at(position, {0, 0, 0}, {0, 1, 0}, 0.8), cube());
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
    EXPECT_LE(glm::length(a - b), tolerance)
        << a.x << "," << a.y << "," << a.z << " and " << b.x << "," << b.y << "," << b.z;
}

TEST(CameraRig, StaysTheGivenCameraUntilItIsMoved) {
    Camera start = look_at({3, 4, 5}, {1, 0, 0}, glm::normalize(glm::dvec3(0.3, 1, 0)), 0.7);
    start.z_near = 0.125;
    CameraRig rig(start, cube());
    rig.move({}, CameraMode::fly, 1.0);
    EXPECT_TRUE(rig.is_unmoved());
    EXPECT_EQ(rig.camera().world_from_view, start.world_from_view);
    EXPECT_EQ(rig.camera().z_near, 0.125);
}

TEST(CameraRig, FliesForwardBySpeedAndTime) {
    CameraRig rig = rig_at({0, 0, 5});
    rig.set_speed(2.0);
    rig.move({.move = {0, 0, 1}}, CameraMode::fly, 0.5);
    expect_near(rig.camera().position, {0, 0, 4});
    rig.move({.move = {1, 0, 0}, .faster = true}, CameraMode::fly, 0.5);
    expect_near(rig.camera().position, {4, 0, 4});
    rig.move({.move = {0, 1, 0}, .slower = true}, CameraMode::fly, 1.0);
    expect_near(rig.camera().position, {4, 0.5, 4});
}

TEST(CameraRig, TheWheelChangesTheSpeedOfFlyingWithinBounds) {
    CameraRig rig = rig_at({0, 0, 5});
    const double before = rig.speed();
    rig.move({.wheel = 2.0}, CameraMode::fly, 0.1);
    EXPECT_NEAR(rig.speed(), 1.25 * 1.25 * before, 1e-9 * before);
    rig.move({.wheel = 1e4}, CameraMode::fly, 0.1);
    EXPECT_TRUE(std::isfinite(rig.speed()));
    expect_near(rig.camera().position, {0, 0, 5});
}

TEST(CameraRig, LookingUpNeverTurnsOver) {
    CameraRig rig = rig_at({0, 0, 5});
    for (int i = 0; i < 20; ++i) rig.move({.look = {0.0, -0.5}}, CameraMode::fly, 0.02);
    const glm::dvec3 forward = -rig.camera().world_from_view[2];
    EXPECT_GT(forward.y, 0.99);
    EXPECT_GT(rig.camera().world_from_view[1].y, 0.0);
    EXPECT_TRUE(std::isfinite(forward.x + forward.y + forward.z));
    expect_near(rig.camera().position, {0, 0, 5});
}

TEST(CameraRig, OrbitingKeepsDistanceAndTarget) {
    CameraRig rig = rig_at({0, 3, 4});
    const glm::dvec3 focal = rig.focal_point();
    rig.move({.look = {0.2, 0.1}}, CameraMode::orbit, 0.02);
    EXPECT_NEAR(glm::length(rig.camera().position - focal), 5.0, 1e-9);
    expect_near(rig.focal_point(), focal);
    const glm::dvec3 to_focal = glm::normalize(focal - rig.camera().position);
    expect_near(-rig.camera().world_from_view[2], to_focal);
}

TEST(CameraRig, OrbitZoomsAndPans) {
    CameraRig rig = rig_at({0, 0, 5});
    rig.move({.wheel = 3.0}, CameraMode::orbit, 0.02);
    const double distance = glm::length(rig.camera().position - rig.focal_point());
    EXPECT_NEAR(distance, 5.0 * std::pow(0.88, 3.0), 1e-9);
    rig.move({.pan = {1.0, 0.0}}, CameraMode::orbit, 0.02);
    // The former middle of the picture is a window's height further right.
    EXPECT_NEAR(rig.focal_point().x, -2.0 * distance * std::tan(0.4), 1e-9);
}

TEST(CameraRig, FramingSeesEveryCorner) {
    CameraRig rig = rig_at({100, 50, 30});
    rig.frame();
    const glm::dmat4 clip = clip_from_view(rig.camera(), 64, 64);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) != 0 ? 10 : -10, (i & 2) != 0 ? 10 : -10,
                                (i & 4) != 0 ? 10 : -10);
        const glm::dvec3 view =
            glm::transpose(rig.camera().world_from_view) * (corner - rig.camera().position);
        const glm::dvec4 p = clip * glm::dvec4(view, 1.0);
        EXPECT_GT(p.w, 0.0);
        EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), p.w * 1.0001) << i;
    }
}

// The copied options must give the same camera, bit for bit.
TEST(CameraRig, ItsPlaceAsOptionsIsTheSameCamera) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {glm::vec3(-10.0f), glm::vec3(10.0f), glm::vec3(10.0f, -10.0f, 3.0f)};
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, glm::dmat4(1.0)});
    CameraRig rig(look_at({3, 4, 5}, {0, 0, 0}, {0, 1, 0}, 0.8), bounds(scene));
    rig.move({.move = {0.3, 0.2, 1.0}, .look = {0.11, 0.07}}, CameraMode::fly, 0.3);
    CameraChoice choice;
    choice.position = rig.camera().position;
    choice.focal_point = rig.focal_point();
    choice.view_angle = glm::degrees(rig.camera().y_fov);
    const Camera again = choose_camera(choice, scene);
    EXPECT_EQ(again.position, rig.camera().position);
    EXPECT_EQ(again.world_from_view, rig.camera().world_from_view);
    EXPECT_NEAR(again.y_fov, rig.camera().y_fov, 1e-15);
    EXPECT_EQ(again.z_near, rig.camera().z_near);
}

}  // namespace
}  // namespace kilolux
