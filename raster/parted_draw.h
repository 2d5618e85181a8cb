// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>

#include "host/base/system/interrupt.h"

namespace kilolux {

/// Draws a slow pass in short parts where its thread's work is watched: between them the pass can
/// be cancelled, and other contexts of a driver that draws on the CPU can work. Calls `draw` for
/// one part of the rows after the other, each with its own scissor rectangle; once for all rows
/// where the work is not watched. The first part is small in every pass: with more lights a pass
/// can take a thousand times as long as the one before. Passes exceptions of check_interrupt() on;
/// the scissor test then is still on.
template <typename Draw>
void draw_in_parts(int width, int height, Draw draw) {
    constexpr double kPartSeconds = 0.1;
    constexpr int kRows = 4;  // llvmpipe shades blocks of 4 x 4 pixels
    if (!WorkWatch::is_present()) return draw();
    glEnable(GL_SCISSOR_TEST);
    for (int row = 0, rows = kRows; row < height;) {
        check_interrupt_at(static_cast<double>(row) / height);
        const auto start = std::chrono::steady_clock::now();
        glScissor(0, row, width, rows);
        draw();
        glFinish();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        row += rows;
        const double wanted = rows * kPartSeconds / std::max(taken.count(), 1e-6);
        rows = kRows * static_cast<int>(std::clamp(wanted, 1.0 * kRows, 8.0 * rows) / kRows);
    }
    glDisable(GL_SCISSOR_TEST);
    check_interrupt_at(1.0);
}

}  // namespace kilolux
