// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kilolux {

/// From now on a lost X display ends the program at once, with one line and code 1. Xlib calls
/// exit() by itself, which destroys what threads that still render use.
void end_when_display_is_lost();

}  // namespace kilolux
