// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// Moves lights into view space and finds the part of the coarse grid that each can touch.
class PrepareLights {
 public:
    PrepareLights(const Gpu& gpu, const Tuning& tuning);

    /// Enqueues only. `grid` must have fewer than 65536 tiles a side and slices.
    PreparedLights enqueue(const LightInput& input, const View& view, const ClusterGrid& grid,
                           StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    cl::Program program_;
    GrowingBuffer lights_, bounds_, extents_, directional_;
};

}  // namespace kilolux
