// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/pinned_memory.h"

namespace kilolux {

/// A point of the world as a pair of floats: the rounded position, and what rounding lost [m].
struct PointPair {
    float4 high{}, low{};
};
PointPair point_pair(double x, double y, double z);

/// A row for MoveLights::stage(): `light` at a point of the world [m].
WorldLight world_light(const PointPair& position, const Light& light);

/// Lights of the world, kept on the device -> camera-relative lights.
class MoveLights {
 public:
    MoveLights(const Gpu& gpu, const Tuning& tuning);

    /// Room for `count` lights, which the caller fills before upload(). Blocks until the last
    /// upload() is done.
    std::span<WorldLight> stage(std::size_t count);

    /// What was staged is the lights from now on. Enqueues only.
    void upload();

    /// The lights relative to the eye. Enqueues only.
    DeviceArray<Light> enqueue(const PointPair& eye, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    Kernel kernel_;
    PinnedMemory staging_;
    std::size_t staged_ = 0;  // lights
    GrowingArray<WorldLight> world_;
    GrowingArray<Light> lights_;
};

}  // namespace kilolux
