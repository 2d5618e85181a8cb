// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/base/point_pair.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/memory/pinned_memory.h"
#include "host/gpu/stage_info.h"
#include "kernels/shared/light.h"

namespace kilolux {

StageWork move_lights_work(const StageCounts& counts);
inline constexpr StageInfo kMoveLightsStage = {"move_lights", StageGroup::lights, move_lights_work};

/// A row for MoveLights::stage(): `light` at a point of the world [m].
WorldLight world_light(const PointPair& position, const Light& light);

/// Moves lights from world coordinates, in which the device keeps them, to the camera.
class MoveLights {
 public:
    /// Bytes of a light: staged, in the world, relative to the eye.
    static constexpr std::size_t kLightBytes = 2 * sizeof(WorldLight) + sizeof(Light);

    MoveLights(const Gpu& gpu, const Tuning& tuning);

    /// Room for `count` lights, which the caller fills before upload(). Blocks until the last
    /// upload() is done.
    std::span<WorldLight> stage(std::size_t count);

    /// Makes the staged lights the current ones, but for `gap` rows from light `gap_at` on, which
    /// kernels write to world(). Enqueues only.
    void upload(std::size_t gap_at = 0, std::size_t gap = 0);

    /// The lights in the world, until the next upload().
    DeviceArray<WorldLight> world() const { return world_.get(); }

    /// The lights relative to the eye. Enqueues only.
    DeviceArray<Light> enqueue(const PointPair& eye, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    Kernel move_;
    PinnedMemory staging_;
    std::size_t staged_ = 0;  // lights
    GrowingArray<WorldLight> world_;
    GrowingArray<Light> lights_;
};

}  // namespace kilolux
