// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/lit_band.h"
#include "host/render/render_context.h"
#include "raster/forward_pass.h"

namespace kilolux {

/// The fragments of the forward renderers. Their evaluations are those of all fragments, hidden
/// ones too.
StageWork forward_work(const StageCounts& counts);
inline constexpr StageInfo kForwardStage = {"forward", StageGroup::shading, forward_work};
inline constexpr StageInfo kForwardPlusStage = {"forward_plus", StageGroup::shading, forward_work};

/// Shading of `forward` and `forward-plus`: OpenGL shades where it draws. Forward takes every light
/// for every fragment, in the scene's order; forward-plus draws depth first and takes the coarse
/// lists that OpenCL makes.
class ForwardShading {
 public:
    explicit ForwardShading(const RenderContext& context);

    /// Room for the picture's radiance, and for the background that draw() draws over.
    Radiance target(const Sample& sample);

    /// Draws over the settings' background in `radiance`. `lists`: null for every light. Blocks.
    void draw(const Sample& sample, const HostCoarseLists* lists, const Radiance& radiance,
              Measured out);

 private:
    const RenderContext& context_;
    ForwardPass pass_;
    GrowingArray<float> radiance_;
};

}  // namespace kilolux
