// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/stage_timer.h"

namespace kilolux {

/// Calls enqueue() until fits(), of stages that make room for the next call where the last one had
/// too little. The timer keeps the commands of the last call. Returns what it returned.
template <typename Enqueue, typename Fits>
auto repeat_until_fits(StageTimer& timer, const Enqueue& enqueue, const Fits& fits) {
    const StageTimer before = timer;
    auto out = enqueue();
    while (!fits()) {
        timer.drop_commands_since(before);
        out = {};  // arrays that grow must not be held twice
        out = enqueue();
    }
    return out;
}

}  // namespace kilolux
