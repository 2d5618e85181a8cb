// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/key_bindings.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "host/picture/views.h"

namespace kilolux {
namespace {

Actions press(ViewState& state, int key, int modifiers = 0) {
    return obey_key({key, 0, GLFW_PRESS, modifiers}, state);
}

// Whether the key asks for something or changes the state.
bool acts(const ViewState& before, int key, int modifiers) {
    ViewState state = before;
    return press(state, key, modifiers) != Actions{} || state != before;
}

ViewState state_of(RendererKind renderer, ViewKind view) {
    ViewState state;
    state.settings.renderer = renderer;
    state.settings.want.view = view;
    return state;
}

TEST(KeyBindings, EachActsAndNoneTwice) {
    const ViewState one = state_of(RendererKind::deferred, ViewKind::lit);
    const ViewState other = state_of(RendererKind::forward, ViewKind::normal);
    std::set<std::pair<int, int>> keys;
    for (const KeyRow& row : key_rows()) {
        for (const KeyBinding& binding : row.bindings) {
            if (binding.key == 0) continue;
            SCOPED_TRACE(row.keys);
            EXPECT_TRUE(keys.insert({binding.key, binding.modifiers}).second) << binding.key;
            const int held = std::max(binding.modifiers, 0);
            EXPECT_TRUE(acts(one, binding.key, held) || acts(other, binding.key, held));
        }
    }
    EXPECT_FALSE(keys.empty());
}

// "Shift+P": codes of printable keys are those of their letters.
std::string name_of(const KeyBinding& binding) {
    const int held = std::max(binding.modifiers, 0);
    return std::string(held & GLFW_MOD_CONTROL ? "Ctrl+" : "") +
           (held & GLFW_MOD_SHIFT ? "Shift+" : "") + static_cast<char>(binding.key);
}

TEST(KeyBindings, TheHelpNamesTheirKeys) {
    for (const KeyRow& row : key_rows()) {
        std::string words = row.keys;
        std::ranges::replace(words, ',', ' ');
        const std::string names = " " + words + " ";
        for (const KeyBinding& binding : row.bindings) {
            if (binding.key <= GLFW_KEY_SPACE || binding.key > GLFW_KEY_Z) continue;
            EXPECT_NE(names.find(" " + name_of(binding) + " "), std::string::npos)
                << row.keys << " without " << name_of(binding);
        }
    }
}

TEST(KeyBindings, ModifiersChooseAmongTheActionsOfAKey) {
    ViewState state;
    EXPECT_TRUE(press(state, GLFW_KEY_P).save_png);
    EXPECT_FALSE(press(state, GLFW_KEY_P).save_exr);
    EXPECT_TRUE(press(state, GLFW_KEY_P, GLFW_MOD_SHIFT).save_exr);
    EXPECT_FALSE(press(state, GLFW_KEY_P, GLFW_MOD_SHIFT).save_png);
    EXPECT_EQ(press(state, GLFW_KEY_Q), Actions{}) << "which flies down";
    EXPECT_EQ(press(state, GLFW_KEY_P, GLFW_MOD_CONTROL), Actions{});
    EXPECT_TRUE(press(state, GLFW_KEY_Q, GLFW_MOD_CONTROL | GLFW_MOD_CAPS_LOCK).close);
    EXPECT_EQ(state, ViewState{});
}

TEST(KeyBindings, ViewsStepRound) {
    ViewState state;
    std::set<ViewKind> seen;
    for (std::size_t i = 0; i < view_names().size(); ++i) {
        press(state, GLFW_KEY_V);
        seen.insert(state.settings.want.view);
    }
    EXPECT_EQ(seen.size(), view_names().size());
    EXPECT_EQ(state, ViewState{});
    press(state, GLFW_KEY_V, GLFW_MOD_SHIFT);
    EXPECT_EQ(static_cast<std::size_t>(state.settings.want.view), view_names().size() - 1);
    press(state, GLFW_KEY_L);
    EXPECT_EQ(state, ViewState{});
}

// Digits need Shift on some keyboards.
TEST(KeyBindings, DigitsChooseTheRendererWithAnyModifier) {
    ViewState state;
    press(state, GLFW_KEY_3);
    EXPECT_EQ(state.settings.renderer, RendererKind::forward);
    press(state, GLFW_KEY_2, GLFW_MOD_SHIFT);
    EXPECT_EQ(state.settings.renderer, RendererKind::forward_plus);
    press(state, GLFW_KEY_5);
    EXPECT_EQ(state.settings.renderer, RendererKind::forward_plus);
}

}  // namespace
}  // namespace kilolux
