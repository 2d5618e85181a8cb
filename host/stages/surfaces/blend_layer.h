// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

inline constexpr StageInfo kBlendLayerStage = {"blend_layer", StageGroup::picture};

/// Lays the light of surfaces that blend over the light behind them, layer after layer from far to
/// near, by their materials' alpha and what they transmit.
class BlendLayer {
 public:
    BlendLayer(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
               const SurfaceFeatures& surfaces);

    /// `lit`, the light of the layers `surfaces`, over `behind`, at the pixels of `ids`, which
    /// number the triangles of `scene`'s instances. The planes of `behind` hold the layers'
    /// rectangle. Enqueues only.
    void enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene, const GBuffer& surfaces,
                 const Radiance& lit, const Radiance& behind, StageTimer& timer);

 private:
    Tuning tuning_;
    Kernel kernel_;
};

}  // namespace kilolux
