// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "host/picture/crop.h"
#include "host/picture/shared_picture.h"
#include "host/render/pipeline.h"

namespace kilolux {

/// Makes the host's memory of a frame.
inline constexpr StageInfo kAllocateStage = {"allocate", StageGroup::host};
inline constexpr StageInfo kLightInputStage = {"light_input", StageGroup::lights};

/// What a frame shows, and how many of its samples are made.
struct Shot {
    Camera camera;
    double time = 0.0;           // [s]
    DisplayMemory display{};     // see Renderer::render_to()
    int samples = 0;             // the first ones, whose mean it is; 0: all
    std::optional<Band> rows{};  // of a picture that is made by rows
};

/// Renders a frame: see Renderer::render().
Frame render_frame(Pipeline& pipeline, const Shot& shot);

/// See the functions of Renderer with these names.
std::unique_ptr<SharedPicture> begin_rows(const Pipeline& pipeline);
Frame render_strip(Pipeline& pipeline, const Shot& shot);
Frame render_crop(Pipeline& pipeline, const Shot& shot, const PixelRect& rect);
FrameStats render_rows(Pipeline& pipeline, const Shot& shot, SharedPicture& picture);
FrameStats finish_rows(Pipeline& pipeline, const Shot& shot, SharedPicture& picture);

}  // namespace kilolux
