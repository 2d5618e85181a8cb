// SPDX-License-Identifier: Apache-2.0
#include "present/window/screen/read_screen.h"

#include <epoxy/gl.h>

#include <cstring>

namespace kilolux {

Frame read_screen(Screen& screen) {
    const auto pixels = screen.framebuffer();
    const unsigned framebuffer = screen.framebuffer_name();
    Frame frame;
    frame.width = pixels[0];
    frame.height = pixels[1];
    const std::size_t row = 4 * static_cast<std::size_t>(frame.width);
    std::vector<std::uint8_t> rows(row * static_cast<std::size_t>(frame.height));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glReadBuffer(framebuffer == 0 ? GL_BACK : GL_COLOR_ATTACHMENT0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, frame.width, frame.height, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
    frame.display.resize(rows.size());
    // OpenGL's rows begin at the bottom.
    for (std::size_t y = 0; y < static_cast<std::size_t>(frame.height); ++y) {
        const std::size_t from = (static_cast<std::size_t>(frame.height) - 1 - y) * row;
        std::memcpy(&frame.display[y * row], &rows[from], row);
    }
    for (std::size_t i = 3; i < frame.display.size(); i += 4) frame.display[i] = 255;
    return frame;
}

}  // namespace kilolux
