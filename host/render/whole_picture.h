// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/render/settings.h"
#include "host/stages/picture/bloom.h"

namespace kilolux {

/// Whether a stage changes the light of the whole picture before the display shows it, such as
/// bloom. Then bands keep their light until the last one, shading makes no display picture, and
/// the picture has no alpha, since light reaches beyond surfaces.
bool needs_whole_picture(const RenderSettings& settings);

/// Bytes of a pixel that these stages keep on the device; 0 where no stage is on.
std::size_t whole_picture_pixel_bytes(const RenderSettings& settings);

/// The stages that change the light of the whole picture between shading and tone mapping.
class WholePictureStages {
 public:
    /// Compiles the stages that the settings turn on. Throws Error.
    void set(const Gpu& gpu, const RenderSettings& settings);

    /// The light after all stages; `light` itself where none is on. Enqueues only.
    Radiance enqueue(Radiance light, const RenderSettings& settings, StageTimer& timer);

 private:
    std::optional<Bloom> bloom_;
};

}  // namespace kilolux
