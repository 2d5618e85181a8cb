// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/stages/lists/prefix_sum.h"
#include "kernels/shared/lights/light_drift.h"

namespace kilolux {

/// Generated lights that move, kept on the device: their places at any time, in an order in which
/// neighbours in space are beside each other.
class DriftLights {
 public:
    /// Bytes of a light: its path, and its place in the order, twice.
    static constexpr std::size_t kLightBytes = sizeof(LightDrift) + 2 * sizeof(std::uint64_t);

    DriftLights(const Gpu& gpu, const Tuning& tuning);

    /// The first `count` lights of the swarm become the current ones.
    void set(const LightSwarm& swarm, std::size_t count);

    /// Orders the lights by their places at a time: after set(), and before place(). Enqueues only.
    void order(const DriftTime& time, StageTimer& timer);

    /// Writes the lights' rows `first` and following where they are at a time. Enqueues only.
    void place(const DeviceArray<WorldLight>& world, std::size_t first, const DriftTime& time,
               StageTimer& timer);

    /// Numbers of the swarm's lights, in their order. Blocks.
    std::vector<std::uint32_t> download_order() const;

 private:
    Gpu gpu_;
    Tuning tuning_;
    KernelProgram program_;
    Kernel keys_, count_, scatter_, paths_, place_;
    PrefixSum prefix_sum_;
    std::size_t lights_ = 0;
    GrowingArray<LightSwarm> swarm_;
    GrowingArray<LightDrift> drifts_;               // ordered
    GrowingArray<std::uint64_t> order_, unsorted_;  // uint2: key, light
    GrowingArray<uint> counts_, offsets_;
};

}  // namespace kilolux
