// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

StageWork prepare_lights_work(const StageCounts& counts);
inline constexpr StageInfo kPrepareLightsStage = {"prepare_lights", StageGroup::lists,
                                                  prepare_lights_work};

/// Moves lights into view space and finds the part of the coarse grid that each can touch.
class PrepareLights {
 public:
    /// Bytes of a light or node.
    static constexpr std::size_t kLightBytes =
        sizeof(ShadeLight) + sizeof(float4) + sizeof(LightExtent);

    PrepareLights(const Gpu& gpu, const Tuning& tuning);

    /// Enqueues only.
    PreparedLights enqueue(const LightInput& input, const View& view, const ClusterGrid& grid,
                           StageTimer& timer);

 private:
    LightExtraInput turn_extras(const LightInput& input, const View& view, StageTimer& timer);

    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel prepare_, prepare_directional_, turn_rows_;
    GrowingArray<ShadeLight> lights_;
    GrowingArray<float4> bounds_;
    GrowingArray<LightExtent> extents_;
    GrowingArray<DirectionalLight> directional_;
    GrowingArray<AimedProfile> profiles_;
    GrowingArray<LightShape> shapes_;
};

}  // namespace kilolux
