// SPDX-License-Identifier: Apache-2.0
#include "host/stages/move_lights.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "move_lights";

}  // namespace

PointPair point_pair(double x, double y, double z) {
    const auto high = [](double v) { return static_cast<float>(v); };
    const auto low = [](double v) { return static_cast<float>(v - static_cast<float>(v)); };
    return {{high(x), high(y), high(z), 0.0f}, {low(x), low(y), low(z), 0.0f}};
}

MoveLights::MoveLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu, build_program(gpu, kStage), kStage, "move_lights"),
      world_(gpu, "lights"),
      lights_(gpu, "lights") {}

void MoveLights::upload(std::span<const WorldLight> lights) {
    kilolux::upload<WorldLight>(gpu_, world_.reserve(lights.size()), lights);
}

DeviceArray<Light> MoveLights::enqueue(const PointPair& eye, StageTimer& timer) {
    const DeviceArray<WorldLight> world = world_.get();
    const DeviceArray<Light> out = lights_.reserve(world.count());
    if (world.count() == 0) return out;
    kernel_.enqueue(items(world.count(), tuning_.light_group), timer, world,
                    static_cast<uint>(world.count()), eye.high, eye.low, out);
    return out;
}

}  // namespace kilolux
