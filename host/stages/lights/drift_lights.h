// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/memory/pinned_memory.h"
#include "host/stages/lists/prefix_sum.h"
#include "kernels/shared/light_drift.h"

namespace kilolux {

/// A row for DriftLights::stage(): a point light of this intensity [cd] drifts in box `box`. A
/// period is twice the box's extent; `turns` [0, 1) of it lie behind the light at the start, `rate`
/// [1/s] are added, |rate| < 1/2.
LightDrift light_drift(const std::array<double, 3>& turns, const std::array<double, 3>& rate,
                       const std::array<float, 3>& intensity, std::uint32_t box);

/// A box for lights of this range [m].
DriftBox drift_box(const std::array<double, 3>& min, const std::array<double, 3>& extent,
                   float range);

/// Generated lights that move, kept on the device: their places at any time, in an order in which
/// neighbours in space are beside each other.
class DriftLights {
 public:
    /// Bytes of a light: its path staged, uploaded and ordered; its place in the order, twice.
    static constexpr std::size_t kLightBytes = 3 * sizeof(LightDrift) + 2 * sizeof(std::uint64_t);

    DriftLights(const Gpu& gpu, const Tuning& tuning);

    /// Room for `count` lights, which the caller fills before upload(); they stay inside `boxes`.
    /// Blocks until the last upload() is done.
    std::span<LightDrift> stage(std::size_t count, std::span<const DriftBox> boxes);

    /// Makes the staged lights the current ones. Enqueues only.
    void upload();

    /// Orders the lights by their places `seconds` >= 0 after the start: after upload(), and
    /// before place(). Enqueues only.
    void order(double seconds, StageTimer& timer);

    /// Writes the lights' rows `first` and following where they are `seconds` >= 0 after the start.
    /// Enqueues only.
    void place(const DeviceArray<WorldLight>& world, std::size_t first, double seconds,
               StageTimer& timer);

    /// Numbers of the lights as staged, in their order. Blocks.
    std::vector<std::uint32_t> download_order() const;

 private:
    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel keys_, count_, scatter_, permute_, place_;
    PrefixSum prefix_sum_;
    PinnedMemory staging_;
    std::size_t lights_ = 0;
    GrowingArray<LightDrift> drifts_, ordered_;
    GrowingArray<DriftBox> boxes_;
    GrowingArray<std::uint64_t> order_, unsorted_;  // uint2: key, light
    GrowingArray<uint> counts_, offsets_;
};

}  // namespace kilolux
