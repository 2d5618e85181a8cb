// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/move_lights.h"

namespace kilolux {
WorldLight world_light(const PointPair& position, const Light& light) {
    WorldLight out{light, position.low};
    const float range = light.position_range.w;
    out.light.position_range = {position.high.x, position.high.y, position.high.z, range};
    return out;
}

MoveLights::MoveLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      move_(gpu, build_program(gpu, kMoveLightsStage), kMoveLightsStage, "move_lights"),
      staging_(gpu),
      world_(gpu, "lights"),
      lights_(gpu, "lights") {}

std::span<WorldLight> MoveLights::stage(std::size_t count) {
    gpu_.queue.finish();
    staged_ = count;
    if (count == 0) return {};
    std::byte* bytes = staging_.reserve(count * sizeof(WorldLight));
    return {reinterpret_cast<WorldLight*>(bytes), count};
}

void MoveLights::upload(std::size_t gap_at, std::size_t gap) {
    const DeviceArray<WorldLight> world = world_.reserve(staged_ + gap);
    const std::size_t bytes = staged_ * sizeof(WorldLight), before = gap_at * sizeof(WorldLight);
    if (bytes == 0) return;
    const std::byte* from = staging_.reserve(bytes);
    const auto write = [&](std::size_t to, std::size_t begin, std::size_t end) {
        if (begin == end) return;
        gpu_.queue.enqueueWriteBuffer(world, CL_FALSE, to, end - begin, from + begin);
    };
    write(0, 0, before);
    write(before + gap * sizeof(WorldLight), before, bytes);
}

DeviceArray<Light> MoveLights::enqueue(const PointPair& eye, StageTimer& timer) {
    const DeviceArray<WorldLight> world = world_.get();
    DeviceArray<Light> out = lights_.reserve(world.count());
    if (world.count() == 0) return out;
    move_.enqueue(items(world.count(), tuning_.light_group), timer, world,
                  static_cast<uint>(world.count()), eye.high, eye.low, out);
    return out;
}

// Does not count drift_lights.
StageWork move_lights_work(const StageCounts& c) {
    return {.bytes_read = c.lights * sizeof(WorldLight),
            .bytes_written = c.lights * sizeof(Light),
            .launches = 1};
}

}  // namespace kilolux
