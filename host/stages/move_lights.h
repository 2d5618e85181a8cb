// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"

namespace kilolux {

/// A point of the world as a pair of floats: the rounded position, and what rounding lost [m].
struct PointPair {
    float4 high{}, low{};
};
PointPair point_pair(double x, double y, double z);

/// Lights of the world, kept on the device -> camera-relative lights.
class MoveLights {
 public:
    MoveLights(const Gpu& gpu, const Tuning& tuning);

    /// The lights from now on. Returns when `lights` were read.
    void upload(std::span<const WorldLight> lights);

    /// The lights relative to the eye. Enqueues only.
    DeviceArray<Light> enqueue(const PointPair& eye, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<WorldLight> world_;
    GrowingArray<Light> lights_;
};

}  // namespace kilolux
