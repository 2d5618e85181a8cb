// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "host/render/frame_stages.h"
#include "host/stages/surfaces/decode_gbuffer.h"

namespace kilolux {

/// The sample that a frame lit last, on the device.
struct LastSample {
    LitBand& band;
    FrameStages& stages;
    const Camera& camera;
};

/// Pixels of a plane of the view.
inline std::size_t plane_size(const View& view) { return std::size_t{view.stride} * view.height; }

/// Surfaces of a lit band and of the layers before it, as [SURFACE_PLANES][height][stride] floats
/// on the device. Its kernels are built when first asked for.
class SurfaceDecoder {
 public:
    explicit SurfaceDecoder(RenderContext& context) : context_(context) {}

    cl::Buffer of_band(const LitBand& band);
    cl::Buffer of_layer(const LayerStack& layer);

    /// Draws the layers of the sample anew, from far to near, and visits each.
    void each_layer(const LastSample& last, const std::function<void(const LayerStack&)>& visit);

 private:
    RenderContext& context_;
    std::optional<DecodeGBuffer> decode_, decode_layers_;
};

}  // namespace kilolux
