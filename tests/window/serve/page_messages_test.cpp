// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/page_messages.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "present/window/serve/page_keys.h"

namespace kilolux {
namespace {

template <typename Event>
Event only_event(const std::string& text) {
    const auto message = parse_page_message(text);
    if (!message || !std::holds_alternative<InputMessage>(*message)) throw std::runtime_error(text);
    const auto& events = std::get<InputMessage>(*message);
    if (events.size() != 1) throw std::runtime_error(text);
    return std::get<Event>(events[0]);
}

TEST(PageMessages, BecomeEventsOfAWindow) {
    const auto key = only_event<KeyEvent>(R"(["key","KeyW",1,3])");
    EXPECT_EQ(key.key, GLFW_KEY_W);
    EXPECT_EQ(key.action, GLFW_PRESS);
    EXPECT_EQ(key.modifiers, GLFW_MOD_SHIFT | GLFW_MOD_CONTROL);
    const auto button = only_event<ButtonEvent>(R"(["button",1,0,0])");
    EXPECT_EQ(button.button, GLFW_MOUSE_BUTTON_RIGHT);
    EXPECT_EQ(button.action, GLFW_RELEASE);
    EXPECT_EQ(only_event<MoveEvent>(R"(["move",-1,2.5])").y, 2.5);
    EXPECT_EQ(only_event<WheelEvent>(R"(["wheel",0,-1.5])").y, -1.5);
    EXPECT_TRUE(only_event<FocusEvent>(R"(["focus",true])").focused);
    const auto text = std::get<InputMessage>(*parse_page_message(R"(["text",97,8364])"));
    ASSERT_EQ(text.size(), 2u);
    EXPECT_EQ(std::get<TextEvent>(text[1]).code_point, 8364u);
    // A key that GLFW does not know is no error, and no event.
    EXPECT_TRUE(std::get<InputMessage>(*parse_page_message(R"(["key","Lang1",1,0])")).empty());
}

TEST(PageMessages, TellOfThePage) {
    const auto hello =
        std::get<HelloMessage>(*parse_page_message(R"(["hello","abc","tab",1280,720,1.5])"));
    EXPECT_EQ(hello.secret, "abc");
    EXPECT_EQ(hello.tab, "tab");
    EXPECT_EQ(hello.size.width, 1280);
    EXPECT_EQ(hello.size.scale, 1.5f);
    EXPECT_EQ(std::get<SizeMessage>(*parse_page_message(R"(["size",1,8192,4])")).size.height, 8192);
    EXPECT_TRUE(std::get<FullScreenMessage>(*parse_page_message(R"(["full-screen",true])")).on);
    EXPECT_EQ(std::get<ShownMessage>(*parse_page_message(R"(["shown",4294967295])")).picture,
              4294967295u);
    EXPECT_TRUE(std::holds_alternative<AliveMessage>(*parse_page_message(R"(["alive"])")));
}

TEST(PageMessages, AnythingElseIsRefused) {
    for (const char* text : {"",
                             "{}",
                             "[]",
                             "null",
                             "1",
                             "\"move\"",
                             "[1]",
                             "[\"no\"]",
                             "[\"move\"]",
                             "[\"move\",1]",
                             "[\"move\",1,2,3]",
                             "[\"move\",\"1\",2]",
                             "[\"move\",null,2]",
                             "[\"move\",1e6,2]",
                             "[\"move\",1e999,2]",
                             "[\"move\",NaN,2]",
                             "[\"wheel\",0,101]",
                             "[\"button\",3,1,0]",
                             "[\"button\",-1,1,0]",
                             "[\"button\",0.5,1,0]",
                             "[\"button\",0,2,0]",
                             "[\"button\",0,1,16]",
                             "[\"key\",87,1,0]",
                             "[\"key\",\"KeyW\",3,0]",
                             "[\"focus\",1]",
                             "[\"text\",31]",
                             "[\"text\",1114112]",
                             "[\"text\",\"a\"]",
                             "[\"size\",0,1,1]",
                             "[\"size\",8193,1,1]",
                             "[\"size\",1,1,0]",
                             "[\"size\",1,1,5]",
                             "[\"size\",1.5,1,1]",
                             "[\"shown\",-1]",
                             "[\"shown\",4294967296]",
                             "[\"alive\",1]",
                             "[\"hello\",\"a\",\"b\",1,1]",
                             "[\"move\",1,2] ]",
                             "[[\"move\",1,2]]",
                             "[\"move\\u0000\",1,2]",
                             "[\"focus\",true"}) {
        EXPECT_FALSE(parse_page_message(text)) << text;
    }
    EXPECT_FALSE(parse_page_message(std::string(kLongestPageMessage, '[')));
    EXPECT_FALSE(parse_page_message("[\"text\"" + std::string(kLongestPageMessage, ' ') + "]"));
    std::string many = "[\"text\"";
    for (int i = 0; i < 513; ++i) many += ",97";
    EXPECT_FALSE(parse_page_message(many + "]"));
    EXPECT_FALSE(parse_page_message("[\"hello\",\"a\",\"" + std::string(65, 'b') + "\",1,1,1]"));
    // A secret with too much behind it is a wrong one, which the page says.
    EXPECT_TRUE(parse_page_message("[\"hello\",\"" + std::string(65, 'a') + "\",\"b\",1,1,1]"));
}

// Whatever is changed in a message, it is refused or within the ranges.
TEST(PageMessages, ChangedMessagesAreRefusedOrInRange) {
    const std::vector<std::string> seeds = {R"(["hello","abc","tab",1280,720,1.5])",
                                            R"(["move",-1,2.5])",
                                            R"(["key","KeyW",1,3])",
                                            R"(["button",1,0,0])",
                                            R"(["wheel",0,-1.5])",
                                            R"(["text",97,8364])",
                                            R"(["size",640,480,2])"};
    std::mt19937 random(47);
    int taken = 0, refused = 0;
    for (int i = 0; i < 50'000; ++i) {
        std::string text = seeds[random() % seeds.size()];
        for (std::size_t n = random() % 3 + 1; n > 0; --n) {
            const std::size_t at = random() % text.size();
            if (random() % 4 == 0) {
                text.erase(at, 1);
            } else if (random() % 2 == 0) {
                text[at] = static_cast<char>(random());
            } else {
                text.insert(at, 1, "0123456789eE+-.,\"[]{}\\"[random() % 23]);
            }
            if (text.empty()) text = "[";
        }
        const auto message = parse_page_message(text);
        ++(message ? taken : refused);
        if (!message) continue;
        if (const auto* size = std::get_if<SizeMessage>(&*message)) {
            ASSERT_TRUE(size->size.width >= 1 && size->size.width <= 8192) << text;
            ASSERT_TRUE(size->size.scale >= 0.5f && size->size.scale <= 4.0f) << text;
        }
        const auto* events = std::get_if<InputMessage>(&*message);
        if (events == nullptr) continue;
        for (const InputEvent& event : *events) {
            const auto* move = std::get_if<MoveEvent>(&event);
            ASSERT_TRUE(move == nullptr || std::abs(move->x) <= 1e5) << text;
            const auto* button = std::get_if<ButtonEvent>(&event);
            ASSERT_TRUE(button == nullptr || (button->button >= 0 && button->button <= 2)) << text;
        }
    }
    EXPECT_GT(taken, 500);
    EXPECT_GT(refused, 1000);
}

TEST(PageMessages, KeysAreThoseOfTheirPlaceOnTheKeyboard) {
    EXPECT_EQ(key_of_code("KeyA"), GLFW_KEY_A);
    EXPECT_EQ(key_of_code("Digit0"), GLFW_KEY_0);
    EXPECT_EQ(key_of_code("F1"), GLFW_KEY_F1);
    EXPECT_EQ(key_of_code("F10"), GLFW_KEY_F10);
    EXPECT_EQ(key_of_code("F11"), GLFW_KEY_F11);
    EXPECT_EQ(key_of_code("Numpad7"), GLFW_KEY_KP_7);
    EXPECT_EQ(key_of_code("ArrowLeft"), GLFW_KEY_LEFT);
    EXPECT_EQ(key_of_code("ShiftRight"), GLFW_KEY_RIGHT_SHIFT);
    for (const char* code : {"", "Key", "Keya", "KeyAA", "F0", "F13", "Digit", "Numpad"}) {
        EXPECT_EQ(key_of_code(code), std::nullopt) << code;
    }
}

}  // namespace
}  // namespace kilolux
