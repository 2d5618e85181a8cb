// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "present/window/panel/panel.h"
#include "present/window/screen/input.h"

namespace kilolux {

/// The action of a key while exactly these of Shift and Ctrl are held.
struct KeyBinding {
    static constexpr int kAnyModifiers = -1;

    int key = 0;  // 0: no binding
    int modifiers = 0;
    void (*act)(ViewState& state, Actions& actions) = nullptr;
};

/// A line of the help, with its keys; without bindings it is about other input.
struct KeyRow {
    const char* keys;
    const char* meaning;
    std::array<KeyBinding, 4> bindings{};
};

/// In the order of the help.
std::span<const KeyRow> key_rows();

/// Obeys a key that was pressed: changes the state, and returns what else it asks for.
Actions obey_key(const KeyEvent& key, ViewState& state);

}  // namespace kilolux
