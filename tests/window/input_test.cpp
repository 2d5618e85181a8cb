// SPDX-License-Identifier: Apache-2.0
#include "present/window/screen/input.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace kilolux {
namespace {

InputState with_everything_down() {
    InputState input;
    input.take(KeyEvent{GLFW_KEY_W, 0, GLFW_PRESS, 0});
    input.take(KeyEvent{GLFW_KEY_LEFT_SHIFT, 0, GLFW_PRESS, GLFW_MOD_SHIFT});
    input.take(ButtonEvent{GLFW_MOUSE_BUTTON_RIGHT, GLFW_PRESS, 0});
    return input;
}

TEST(InputState, WhatIsDownStaysDownFromFrameToFrame) {
    InputState input = with_everything_down();
    EXPECT_EQ(input.pressed().size(), 2u);
    input.end_frame();
    EXPECT_TRUE(input.pressed().empty());
    EXPECT_TRUE(input.is_down(GLFW_KEY_W));
    EXPECT_TRUE(input.is_button_down(GLFW_MOUSE_BUTTON_RIGHT));
    input.take(KeyEvent{GLFW_KEY_W, 0, GLFW_RELEASE, 0});
    EXPECT_FALSE(input.is_down(GLFW_KEY_W));
    EXPECT_TRUE(input.is_down(GLFW_KEY_LEFT_SHIFT));
}

TEST(InputState, NothingIsDownWithoutTheFocus) {
    InputState input = with_everything_down();
    input.take(FocusEvent{false});
    EXPECT_FALSE(input.is_down(GLFW_KEY_W));
    EXPECT_FALSE(input.is_down(GLFW_KEY_LEFT_SHIFT));
    EXPECT_FALSE(input.is_button_down(GLFW_MOUSE_BUTTON_RIGHT));
    input.take(FocusEvent{true});
    EXPECT_FALSE(input.is_down(GLFW_KEY_W));
}

TEST(InputState, AClickBetweenTwoFramesIsSeen) {
    InputState input;
    input.take(ButtonEvent{GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0});
    input.take(ButtonEvent{GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0});
    EXPECT_FALSE(input.is_button_down(GLFW_MOUSE_BUTTON_LEFT));
    EXPECT_TRUE(input.was_button_down(GLFW_MOUSE_BUTTON_LEFT));
    input.end_frame();
    EXPECT_FALSE(input.was_button_down(GLFW_MOUSE_BUTTON_LEFT));
}

TEST(InputState, KnowsBothKeysOfAModifier) {
    for (const int key : {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL}) {
        InputState input;
        input.take(KeyEvent{key, 0, GLFW_PRESS, GLFW_MOD_CONTROL});
        EXPECT_TRUE(input.is_control_down());
        EXPECT_FALSE(input.is_shift_down() || input.is_alt_down());
        input.take(KeyEvent{key, 0, GLFW_RELEASE, 0});
        EXPECT_FALSE(input.is_control_down());
    }
}

}  // namespace
}  // namespace kilolux
