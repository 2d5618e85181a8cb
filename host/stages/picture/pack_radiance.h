// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kPackRadianceStage = {"pack_radiance", StageGroup::picture};

/// Four floats, or four halves (values above 65504 become 65504); or a 2D image of any format that
/// takes floats.
enum class RadianceFormat { float4, half4, image };

/// Writes radiance as RGBA pixels for another renderer, alpha 1.
class PackRadiance {
 public:
    PackRadiance(const Gpu& gpu, const Tuning& tuning, RadianceFormat format);

    /// Writes to `to`, [height][pitch] pixels, rows from the top. `pitch` 0: the width. Enqueues
    /// only. Throws Error where `to` is too small or not of its kind.
    void enqueue(const Radiance& radiance, const cl::Memory& to, uint pitch, StageTimer& timer);

 private:
    Tuning tuning_;
    RadianceFormat format_;
    Kernel kernel_;
};

}  // namespace kilolux
