// SPDX-License-Identifier: Apache-2.0
#include "host/render/read/surface_decoder.h"

namespace kilolux {

cl::Buffer SurfaceDecoder::of_band(const LitBand& band) {
    if (!decode_) decode_.emplace(context_.gpu, context_.tuning, context_.plan.kernels);
    StageTimer untimed;
    return decode_->enqueue(band.surfaces, untimed);
}

cl::Buffer SurfaceDecoder::of_layer(const LayerStack& layer) {
    if (!decode_layers_) {
        decode_layers_.emplace(context_.gpu, context_.tuning, layer_plan(context_).kernels);
    }
    StageTimer untimed;
    return decode_layers_->enqueue(layer.surfaces, untimed);
}

void SurfaceDecoder::each_layer(const LastSample& last,
                                const std::function<void(const LayerStack&)>& visit) {
    if (!context_.blends()) return;
    const View& view = last.band.surfaces.view;
    const Band rows{static_cast<int>(view.first_row), static_cast<int>(view.height)};
    last.stages.layer_surfaces().each(context_.device_surfaces(),
                                      crop(last.camera, context_.settings.height, rows),
                                      last.band.surfaces, visit);
}

}  // namespace kilolux
