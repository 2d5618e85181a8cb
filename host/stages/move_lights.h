// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/pinned_memory.h"
#include "kernels/shared/light_drift.h"

namespace kilolux {

/// A point of the world as a pair of floats: the rounded position, and what rounding lost [m].
struct PointPair {
    float4 high{}, low{};
};
PointPair point_pair(double x, double y, double z);

/// A row for MoveLights::stage(): `light` at a point of the world [m].
WorldLight world_light(const PointPair& position, const Light& light);

/// A row for MoveLights::stage_drifts(): how the light `row` drifts in the box `box`. A period is
/// twice the box's extent; `turns` [0, 1) of it lie behind the light at the start, `rate` [1/s] are
/// added, |rate| < 1/2.
LightDrift light_drift(std::uint32_t row, std::uint32_t box, const std::array<double, 3>& turns,
                       const std::array<double, 3>& rate);
DriftBox drift_box(const std::array<double, 3>& min, const std::array<double, 3>& extent);

/// Lights of the world, kept on the device -> camera-relative lights.
class MoveLights {
 public:
    MoveLights(const Gpu& gpu, const Tuning& tuning);

    /// Room for `count` lights, which the caller fills before upload(). Blocks until the last
    /// upload() is done.
    std::span<WorldLight> stage(std::size_t count);

    /// Room for the drifts of `count` of the staged lights, which the caller fills before upload();
    /// after stage(), which forgets them. They stay inside `boxes`.
    std::span<LightDrift> stage_drifts(std::size_t count, std::span<const DriftBox> boxes);

    /// What was staged is the lights from now on. Enqueues only.
    void upload();

    /// Puts the drifting lights where they are `seconds` [0, 1) after the start. Enqueues only.
    void drift(double seconds, StageTimer& timer);

    /// The lights relative to the eye. Enqueues only.
    DeviceArray<Light> enqueue(const PointPair& eye, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    Kernel drift_, move_;
    PinnedMemory staging_, drift_staging_;
    std::size_t staged_ = 0, drifting_ = 0;  // lights
    GrowingArray<WorldLight> world_;
    GrowingArray<LightDrift> drifts_;
    GrowingArray<DriftBox> boxes_;
    GrowingArray<Light> lights_;
};

}  // namespace kilolux
