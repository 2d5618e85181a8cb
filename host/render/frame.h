// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/pipeline.h"

namespace kilolux {

/// What a frame shows, and how many of its samples are made.
struct Shot {
    Camera camera;
    double time = 0.0;        // [s]
    DisplayMemory display{};  // see Renderer::render_to()
    int samples = 0;          // the first ones, whose mean it is; 0: all
};

/// Renders a frame: see Renderer::render().
Frame render_frame(Pipeline& pipeline, const Shot& shot);

}  // namespace kilolux
