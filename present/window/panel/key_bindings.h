// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/panel/panel.h"
#include "present/window/screen/input.h"

namespace kilolux {

/// Obeys a key that was pressed: changes the state, and returns what else it asks for.
Actions obey_key(const KeyEvent& key, ViewState& state);

}  // namespace kilolux
