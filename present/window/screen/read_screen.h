// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/picture/frame.h"
#include "present/window/screen/screen.h"

namespace kilolux {

/// What was drawn to the screen's framebuffer last: Frame::display, opaque. Waits for OpenGL.
Frame read_screen(Screen& screen);

}  // namespace kilolux
