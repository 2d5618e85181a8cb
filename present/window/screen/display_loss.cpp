// SPDX-License-Identifier: Apache-2.0
#include "present/window/screen/display_loss.h"

#include <X11/Xlib.h>
#include <unistd.h>

#include <string_view>

namespace kilolux {
namespace {

int end_at_once(Display*) {
    constexpr std::string_view kText = "kilolux: window: the display was closed\n";
    // The exit code does not depend on whether the line could be written.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
    _exit(1);
}

}  // namespace

void end_when_display_is_lost() { XSetIOErrorHandler(end_at_once); }

}  // namespace kilolux
