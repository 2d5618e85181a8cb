// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/gpu/device.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// How a picture is made within the available memory.
struct MemoryPlan {
    int band_rows = 0;               // rows made at once: a multiple of FINE_TILE
    int least_rows = 0;              // the fewest that can be made at once, likewise
    int strip_rows = 0;              // of a picture's strips: Renderer::strips()
    std::uint64_t bytes = 0;         // what that takes, light lists aside
    std::uint64_t held_bytes = 0;    // that finished pictures may take until they are written
    std::uint64_t device_bytes = 0;  // that device buffers may take: GrowingBuffer's budget
};

/// Pictures of more pixels are handed over in strips where the caller takes them so; smaller ones
/// where they do not fit as a whole.
inline constexpr std::uint64_t kLargePicture = std::uint64_t{1} << 26;
/// The most pixels of a strip, but for strips of the least rows.
inline constexpr std::uint64_t kStripPixels = std::uint64_t{1} << 24;

/// What a renderer may take: its share of settings.max_memory_bytes (0: of most of what is
/// available).
std::uint64_t memory_limit(const RenderSettings& settings);

/// The highest bands that fit into memory_limit() and into the device's buffers. The picture's bits
/// do not depend on it. Throws Error, before anything large is allocated, when even the lowest
/// bands do not fit: it says what is needed and what is available. `draws_in_opencl`: OpenGL has no
/// targets.
MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings, const ScenePlan& plan,
                       const DeviceInfo& device, bool draws_in_opencl = false);

/// Throws Error when the program and so many generated lights do not fit; called before a scene is
/// loaded.
void check_light_memory(std::uint64_t lights, const RenderSettings& settings);

}  // namespace kilolux
