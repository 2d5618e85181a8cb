// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/steering.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace kilolux {
namespace {

InputState pressing(std::initializer_list<int> keys) {
    InputState input;
    for (const int key : keys) input.take(KeyEvent{key, 0, GLFW_PRESS, 0});
    return input;
}

// Drags by a quarter of a window 400 high to the right, and up by half.
InputState dragging(int button) {
    InputState input;
    input.take(MoveEvent{10.0, 300.0});
    input.take(ButtonEvent{button, GLFW_PRESS, 0});
    input.take(MoveEvent{110.0, 100.0});
    return input;
}

TEST(CameraInputOfTheWindow, KeysMoveUnlessATextFieldOrControlTakesThem) {
    const InputState held = pressing({GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_W, GLFW_KEY_LEFT_SHIFT});
    const CameraInput motion = camera_input({.input = held}, CameraMode::fly);
    EXPECT_EQ(motion.move, glm::dvec3(1, -1, 1));
    EXPECT_TRUE(motion.faster);
    EXPECT_FALSE(motion.slower);
    EXPECT_FALSE(camera_input({.input = held, .has_keys = false}, CameraMode::fly).any());
    EXPECT_EQ(camera_input({.input = pressing({GLFW_KEY_A, GLFW_KEY_D})}, CameraMode::fly).move,
              glm::dvec3(0.0));
    const InputState leaves = pressing({GLFW_KEY_LEFT_CONTROL, GLFW_KEY_Q});
    EXPECT_FALSE(camera_input({.input = leaves}, CameraMode::fly).any());
}

TEST(CameraInputOfTheWindow, TheWheelIsThePanelsWhereTheMouseIsOnIt) {
    InputState input;
    input.take(WheelEvent{0.0, 2.0});
    EXPECT_EQ(camera_input({.input = input}, CameraMode::fly).wheel, 2.0);
    EXPECT_EQ(camera_input({.input = input, .has_wheel = false}, CameraMode::fly).wheel, 0.0);
}

TEST(CameraInputOfTheWindow, DragsTurnAndInOrbitOtherButtonsPan) {
    const glm::dvec2 dragged(0.25, -0.5);
    const glm::dvec2 none(0.0);
    for (const int button :
         {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE}) {
        const InputState input = dragging(button);
        const SteeringInput from{.input = input, .drags = true, .height = 400};
        const CameraInput flies = camera_input(from, CameraMode::fly);
        EXPECT_EQ(flies.look, dragged) << button;
        EXPECT_EQ(flies.pan, none) << button;
        const CameraInput orbits = camera_input(from, CameraMode::orbit);
        const bool pans = button != GLFW_MOUSE_BUTTON_LEFT;
        EXPECT_EQ(orbits.pan, pans ? dragged : none) << button;
        EXPECT_EQ(orbits.look, pans ? none : dragged) << button;
        EXPECT_FALSE(camera_input({.input = input, .height = 400}, CameraMode::fly).any())
            << "a drag that began on the panel";
    }
}

}  // namespace
}  // namespace kilolux
