// SPDX-License-Identifier: Apache-2.0
// The stages of a frame that the host or OpenGL runs.
#pragma once

#include "host/gpu/stage_info.h"
#include "host/stages/shading/instruction_counts.h"

namespace kilolux {

/// Brings what OpenGL drew to the device: by a copy, or, where the device has its own memory, by an
/// upload.
inline StageWork bridge_work(const StageCounts& c) {
    const double bytes = c.bridge_bytes_per_pixel * c.pixels;
    if (c.device_is_host) return {.bytes_read = bytes, .bytes_written = bytes};
    return {.bytes_uploaded = bytes};
}

/// The fragments of the forward renderers. Their evaluations are those of all fragments, hidden
/// ones too.
inline StageWork forward_work(const StageCounts& c) {
    return {.bytes_written = kRadianceBytes * c.pixels,
            .instructions = shading_instructions(c),
            .evaluations = full_evaluations(c)};
}

/// Makes the host's memory of a frame.
inline constexpr StageInfo kAllocateStage = {"allocate", StageGroup::host};
inline constexpr StageInfo kLightInputStage = {"light_input", StageGroup::lights};
inline constexpr StageInfo kGeometryStage = {"geometry", StageGroup::surfaces};
inline constexpr StageInfo kGBufferBridgeStage = {"gbuffer_bridge", StageGroup::surfaces,
                                                  bridge_work, true};
inline constexpr StageInfo kShadowSceneStage = {"shadow_scene", StageGroup::shadows};
inline constexpr StageInfo kBlendedStage = {"blended", StageGroup::picture};
inline constexpr StageInfo kForwardStage = {"forward", StageGroup::shading, forward_work};
inline constexpr StageInfo kForwardPlusStage = {"forward_plus", StageGroup::shading, forward_work};

}  // namespace kilolux
