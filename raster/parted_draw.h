// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "host/base/system/interrupt.h"

namespace kilolux {

/// What is known of a pass before it is drawn.
struct PassCost {
    double expected_s = std::numeric_limits<double>::infinity();  // what it took before
    double first_pixels = 0.0;  // that are quick on any device; the first part where it is unknown
};

/// Draws a slow pass in short parts, see part_seconds(): between them the pass can be ended, and
/// other contexts of a driver that draws on the CPU can work. Calls `draw` for one part after the
/// other, rows or less than four, each with its own scissor rectangle; once for a pass that nothing
/// would end, or that takes no longer than a part by `cost`. Passes exceptions of check_interrupt()
/// on; the scissor test then is still on.
template <typename Draw>
void draw_in_parts(int width, int height, const PassCost& cost, Draw draw) {
    constexpr int kTall = 4, kWide = 16;  // llvmpipe shades blocks of 4 x 4 pixels
    const double part_s = part_seconds();
    if (cost.expected_s <= part_s) return draw();
    const double all = static_cast<double>(width) * height;
    double wanted = std::max(cost.first_pixels, all * part_s / cost.expected_s);  // pixels
    glEnable(GL_SCISSOR_TEST);
    for (int row = 0, column = 0; row < height;) {
        check_interrupt_at((static_cast<double>(row) + kTall * column / width) / height);
        const double blocks = std::min(wanted, all) / (kTall * kWide);
        const int columns = std::min(width - column, kWide * std::max(static_cast<int>(blocks), 1));
        const int rows =
            column == 0
                ? kTall * std::max(static_cast<int>(std::min(wanted, all) / (kTall * width)), 1)
                : kTall;
        const auto start = std::chrono::steady_clock::now();
        glScissor(column, row, columns, rows);
        draw();
        glFinish();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        const double pixels = static_cast<double>(columns) * rows;
        wanted = pixels * std::min(part_s / std::max(taken.count(), 1e-6), 8.0);
        column += columns;
        if (column < width) continue;
        column = 0;
        row += rows;
    }
    glDisable(GL_SCISSOR_TEST);
    check_interrupt_at(1.0);
}

}  // namespace kilolux
