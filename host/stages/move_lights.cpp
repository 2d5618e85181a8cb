// SPDX-License-Identifier: Apache-2.0
#include "host/stages/move_lights.h"

#include <cmath>

namespace kilolux {
namespace {

constexpr std::string_view kMoveLightsStage = "move_lights";

// A share of a turn, or of a second, in units of 2^-64; |share| < 1. What is next to 1 is 0.
ulong fixed_point(double share) {
    const double units = std::ldexp(std::abs(share), 64);
    const ulong magnitude = units < 0x1p64 ? static_cast<ulong>(units) : 0;
    return share < 0.0 ? 0 - magnitude : magnitude;
}

uint4 upper_halves(const std::array<ulong, 3>& v, uint w) {
    const auto upper = [](ulong value) { return static_cast<uint>(value >> 32); };
    return {upper(v[0]), upper(v[1]), upper(v[2]), w};
}

uint4 lower_halves(const std::array<ulong, 3>& v, uint w) {
    const auto lower = [](ulong value) { return static_cast<uint>(value); };
    return {lower(v[0]), lower(v[1]), lower(v[2]), w};
}

std::array<ulong, 3> fixed_points(const std::array<double, 3>& shares) {
    return {fixed_point(shares[0]), fixed_point(shares[1]), fixed_point(shares[2])};
}

}  // namespace

PointPair point_pair(double x, double y, double z) {
    const auto high = [](double v) { return static_cast<float>(v); };
    const auto low = [](double v) { return static_cast<float>(v - static_cast<float>(v)); };
    return {{high(x), high(y), high(z), 0.0f}, {low(x), low(y), low(z), 0.0f}};
}

WorldLight world_light(const PointPair& position, const Light& light) {
    WorldLight out{light, position.low};
    const float range = light.position_range.w;
    out.light.position_range = {position.high.x, position.high.y, position.high.z, range};
    return out;
}

LightDrift light_drift(std::uint32_t row, std::uint32_t box, const std::array<double, 3>& turns,
                       const std::array<double, 3>& rate) {
    const auto at = fixed_points(turns), by = fixed_points(rate);
    return {upper_halves(at, row), lower_halves(at, box), upper_halves(by, 0), lower_halves(by, 0)};
}

DriftBox drift_box(const std::array<double, 3>& min, const std::array<double, 3>& extent) {
    const PointPair corner = point_pair(min[0], min[1], min[2]);
    const PointPair size = point_pair(extent[0], extent[1], extent[2]);
    return {corner.high, corner.low, size.high, size.low};
}

MoveLights::MoveLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      drift_(gpu, build_program(gpu, kMoveLightsStage), kMoveLightsStage, "drift_lights"),
      move_(gpu, build_program(gpu, kMoveLightsStage), kMoveLightsStage, "move_lights"),
      staging_(gpu),
      drift_staging_(gpu),
      world_(gpu, "lights"),
      drifts_(gpu, "lights"),
      boxes_(gpu, "lights"),
      lights_(gpu, "lights") {}

std::span<WorldLight> MoveLights::stage(std::size_t count) {
    gpu_.queue.finish();
    staged_ = count;
    drifting_ = 0;
    if (count == 0) return {};
    std::byte* bytes = staging_.reserve(count * sizeof(WorldLight));
    return {reinterpret_cast<WorldLight*>(bytes), count};
}

std::span<LightDrift> MoveLights::stage_drifts(std::size_t count, std::span<const DriftBox> boxes) {
    drifting_ = count;
    if (count == 0) return {};
    kilolux::upload<DriftBox>(gpu_, boxes_.reserve(boxes.size()), boxes);
    std::byte* bytes = drift_staging_.reserve(count * sizeof(LightDrift));
    return {reinterpret_cast<LightDrift*>(bytes), count};
}

void MoveLights::upload() {
    const DeviceArray<WorldLight> world = world_.reserve(staged_);
    if (staged_ == 0) return;
    const std::size_t bytes = staged_ * sizeof(WorldLight);
    gpu_.queue.enqueueWriteBuffer(world, CL_FALSE, 0, bytes, staging_.reserve(bytes));
    if (drifting_ == 0) return;
    const std::size_t drift_bytes = drifting_ * sizeof(LightDrift);
    gpu_.queue.enqueueWriteBuffer(drifts_.reserve(drifting_), CL_FALSE, 0, drift_bytes,
                                  drift_staging_.reserve(drift_bytes));
}

void MoveLights::drift(double seconds, StageTimer& timer) {
    if (drifting_ == 0) return;
    const ulong elapsed = fixed_point(seconds);
    drift_.enqueue(items(drifting_, tuning_.light_group), timer, drifts_.get(),
                   static_cast<uint>(drifting_), boxes_.get(), static_cast<uint>(elapsed >> 32),
                   static_cast<uint>(elapsed), world_.get());
}

DeviceArray<Light> MoveLights::enqueue(const PointPair& eye, StageTimer& timer) {
    const DeviceArray<WorldLight> world = world_.get();
    const DeviceArray<Light> out = lights_.reserve(world.count());
    if (world.count() == 0) return out;
    move_.enqueue(items(world.count(), tuning_.light_group), timer, world,
                  static_cast<uint>(world.count()), eye.high, eye.low, out);
    return out;
}

}  // namespace kilolux
