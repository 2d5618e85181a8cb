// SPDX-License-Identifier: Apache-2.0
#include "present/window/screen/event_queue.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace kilolux {
namespace {

KeyEvent key(int code, int action) { return {code, 0, action, 0}; }

ButtonEvent button(int action) { return {GLFW_MOUSE_BUTTON_LEFT, action, 0}; }

TEST(EventQueue, GivesEventsInTheirOrder) {
    EventQueue queue;
    queue.post(key(GLFW_KEY_W, GLFW_PRESS));
    queue.post(MoveEvent{1.0, 2.0});
    queue.post(TextEvent{'w'});
    const std::vector<InputEvent> events = queue.take(0.01);
    ASSERT_EQ(events.size(), 3u);
    EXPECT_TRUE(std::holds_alternative<KeyEvent>(events[0]));
    EXPECT_TRUE(std::holds_alternative<MoveEvent>(events[1]));
    EXPECT_TRUE(std::holds_alternative<TextEvent>(events[2]));
    EXPECT_TRUE(queue.empty());
}

// A click into a field and what is typed arrive together after a slow frame. The field must have
// the keys before they come: else "2" is the key that changes the renderer.
TEST(EventQueue, TypedTextWaitsUntilAClickHasHadItsEffect) {
    EventQueue queue;
    queue.post(button(GLFW_PRESS));
    queue.post(button(GLFW_RELEASE));
    queue.post(key(GLFW_KEY_2, GLFW_PRESS));
    queue.post(TextEvent{'2'});
    queue.post(button(GLFW_PRESS));  // must not overtake the text
    EXPECT_EQ(queue.take(0.01).size(), 2u);
    EXPECT_EQ(queue.take(0.01).size(), 0u);
    EXPECT_EQ(queue.take(0.01).size(), 3u);
    EXPECT_TRUE(queue.empty());
}

// A finger's tap or a whole drag can arrive at once. The panel must know the place before the
// press: else it drags the camera from where the mouse was before; and the last place before the
// release.
TEST(EventQueue, ButtonsGoDownAndUpWhereTheMouseWas) {
    EventQueue queue;
    queue.post(MoveEvent{1.0, 2.0});
    queue.post(MoveEvent{3.0, 4.0});
    queue.post(button(GLFW_PRESS));
    queue.post(MoveEvent{5.0, 4.0});
    queue.post(button(GLFW_RELEASE));
    queue.post(MoveEvent{-1.0, -1.0});
    std::vector<std::size_t> counts;
    while (!queue.empty()) counts.push_back(queue.take(0.01).size());
    EXPECT_EQ(counts, (std::vector<std::size_t>{2, 1, 1, 1, 1}));
}

TEST(EventQueue, DropsWhatTheUserMeantForAnotherPicture) {
    EventQueue queue;
    queue.post(key(GLFW_KEY_2, GLFW_PRESS));
    queue.post(key(GLFW_KEY_2, GLFW_RELEASE));
    queue.post(TextEvent{'2'});
    queue.post(WheelEvent{0.0, 1.0});
    queue.post(button(GLFW_PRESS));
    queue.post(button(GLFW_RELEASE));
    queue.post(MoveEvent{3.0, 4.0});
    const std::vector<InputEvent> events = queue.take(1.1 * EventQueue::kStaleSeconds);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(std::get<KeyEvent>(events[0]).action, GLFW_RELEASE);
    EXPECT_EQ(std::get<ButtonEvent>(events[1]).action, GLFW_RELEASE);
    ASSERT_EQ(queue.take(0.01).size(), 1u);
    EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace kilolux
