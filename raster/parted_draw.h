// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>

#include "host/base/system/interrupt.h"

namespace kilolux {

/// Draws a slow pass in short parts where its thread's work is watched: between them the pass can
/// be cancelled, and other contexts of a driver that draws on the CPU can work.
class PartedDraw {
 public:
    /// Calls `draw` for one part of the rows after the other, each with its own scissor rectangle;
    /// once for all rows where the work is not watched. Passes exceptions of check_interrupt() on;
    /// the scissor test then is still on.
    template <typename Draw>
    void draw(int width, int height, Draw draw) {
        if (!WorkWatch::is_present()) return draw();
        glEnable(GL_SCISSOR_TEST);
        for (int row = 0; row < height;) {
            check_interrupt_at(static_cast<double>(row) / height);
            const auto start = std::chrono::steady_clock::now();
            glScissor(0, row, width, rows_);
            draw();
            glFinish();
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
            row += rows_;
            const double wanted = rows_ * kPartSeconds / std::max(taken.count(), 1e-6);
            rows_ = kRows * static_cast<int>(std::clamp(wanted, 1.0 * kRows, 8.0 * rows_) / kRows);
        }
        glDisable(GL_SCISSOR_TEST);
        check_interrupt_at(1.0);
    }

 private:
    static constexpr double kPartSeconds = 0.1;
    static constexpr int kRows = 4;  // llvmpipe shades blocks of 4 x 4 pixels

    int rows_ = kRows;  // of the next part
};

}  // namespace kilolux
