// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kilolux {

/// From now on a lost X display ends the program at once, with one line and code 1. Otherwise Xlib
/// calls exit(), which destroys objects that rendering threads still use.
void end_when_display_is_lost();

}  // namespace kilolux
