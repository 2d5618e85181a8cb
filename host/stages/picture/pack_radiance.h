// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"

namespace kilolux {

/// Four floats, or four halves (65504 stands for what exceeds it); or a 2D image of any format
/// that takes floats.
enum class RadianceFormat { float4, half4, image };

/// Radiance as RGBA pixels of another renderer, alpha 1.
class PackRadiance {
 public:
    PackRadiance(const Gpu& gpu, const Tuning& tuning, RadianceFormat format);

    /// Into `to`, [height][pitch] pixels, rows from the top. `pitch` 0: the width. Enqueues only.
    /// Throws Error for one that is too small or not of its kind.
    void enqueue(const Radiance& radiance, const cl::Memory& to, uint pitch, StageTimer& timer);

 private:
    Tuning tuning_;
    RadianceFormat format_;
    Kernel kernel_;
};

}  // namespace kilolux
