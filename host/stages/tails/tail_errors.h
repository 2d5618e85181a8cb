// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

inline constexpr StageInfo kTailErrorsStage = {"tail_errors", StageGroup::picture};

/// Errors that lights without a range of their own cause in a picture, pixel by pixel. They are
/// AOVs; a frame without these does not compute them.
class TailErrors {
 public:
    TailErrors(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// A bound of the radiance that ranges take away: [3][height][stride], 0 for background. `own`:
    /// the camera-relative lights, of which those with a negative range have none of their own.
    /// Enqueues only.
    DeviceArray<float> bound(const LitPixels& lit, const DeviceArray<Light>& own,
                             const ClusterBoxes& boxes, StageTimer& timer);

    /// With a light tree, a bound of what its nodes add or leave out. Enqueues only.
    DeviceArray<float> tree_bound(const LitPixels& lit, StageTimer& timer);

    /// The estimated variance of the luminance that random ranges cause: [height][stride]; for
    /// background 0, with sampled shadows undefined. `shadow_variance`: with sampled shadows,
    /// theirs, which is added. `shadows`: with shadows, what CastShadows made. Enqueues only.
    DeviceArray<float> variance(const LitPixels& lit, const ShadowWords& shadows,
                                const ShadowSamples& samples,
                                const DeviceArray<float>& shadow_variance, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    KernelFeatures features_;
    std::optional<Kernel> moments_, bound_, tree_bound_, variance_;  // made when first asked for
    GrowingArray<float> moment_rows_, bounds_, variances_;
};

}  // namespace kilolux
