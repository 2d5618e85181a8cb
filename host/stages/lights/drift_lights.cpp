// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/drift_lights.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/base/light_cells.h"
#include "host/base/point_pair.h"
#include "host/stages/lights/move_lights.h"

namespace kilolux {
namespace {

constexpr uint kDigitBits = 8;  // of kernels/lights/drift_lights.cl
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr std::size_t kLeastChunk = 256;  // lights: as many as a chunk has counters

// A share of a turn, or of a second, in units of 2^-64; |share| < 1. A share that rounds to 1
// becomes 0.
ulong fixed_point(double share) {
    const double units = std::ldexp(std::abs(share), 64);
    const ulong magnitude = units < 0x1p64 ? static_cast<ulong>(units) : 0;
    return share < 0.0 ? 0 - magnitude : magnitude;
}

uint high_word(ulong v) { return static_cast<uint>(v >> 32); }
uint low_word(ulong v) { return static_cast<uint>(v); }

// Time since the start, in the kernels' units.
struct Elapsed {
    uint seconds, rest_high, rest_low;

    void each(auto&& set) const {
        set("seconds", seconds);
        set("rest_high", rest_high);
        set("rest_low", rest_low);
    }
};

Elapsed elapsed(double seconds) {
    const double whole = std::floor(seconds);
    const ulong rest = fixed_point(seconds - whole);
    return {static_cast<uint>(whole), high_word(rest), low_word(rest)};
}

}  // namespace

LightDrift light_drift(const std::array<double, 3>& turns, const std::array<double, 3>& rate,
                       const std::array<float, 3>& intensity, std::uint32_t box) {
    std::array<ulong, 3> at{}, by{};
    std::ranges::transform(turns, at.begin(), fixed_point);
    std::ranges::transform(rate, by.begin(), fixed_point);
    const auto bits = [&](std::size_t i) { return std::bit_cast<uint>(intensity[i]); };
    return {{high_word(at[0]), high_word(at[1]), high_word(at[2]), box},
            {low_word(at[0]), low_word(at[1]), low_word(at[2]), bits(0)},
            {high_word(by[0]), high_word(by[1]), high_word(by[2]), bits(1)},
            {low_word(by[0]), low_word(by[1]), low_word(by[2]), bits(2)}};
}

DriftBox drift_box(const std::array<double, 3>& min, const std::array<double, 3>& extent,
                   float range) {
    const PointPair corner = point_pair(min[0], min[1], min[2]);
    const PointPair size = point_pair(extent[0], extent[1], extent[2]);
    DriftBox out{corner.high, corner.low, size.high, size.low};
    out.min.w = range;
    out.extent.w = static_cast<float>(1.0 / light_cell_edge(range));
    return out;
}

DriftLights::DriftLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, "drift_lights")),
      keys_(gpu, program_, kMoveLightsStage, "drift_keys"),
      count_(gpu, program_, kMoveLightsStage, "drift_count"),
      scatter_(gpu, program_, kMoveLightsStage, "drift_scatter"),
      permute_(gpu, program_, kMoveLightsStage, "drift_permute"),
      place_(gpu, program_, kMoveLightsStage, "drift_lights"),
      prefix_sum_(gpu, tuning, kMoveLightsStage),
      staging_(gpu),
      drifts_(gpu, "lights"),
      ordered_(gpu, "lights"),
      boxes_(gpu, "lights"),
      order_(gpu, "lights"),
      unsorted_(gpu, "lights"),
      counts_(gpu, "lights"),
      offsets_(gpu, "lights") {}

std::span<LightDrift> DriftLights::stage(std::size_t count, std::span<const DriftBox> boxes) {
    gpu_.queue.finish();
    lights_ = count;
    if (count == 0) return {};
    kilolux::upload<DriftBox>(gpu_, boxes_.reserve(boxes.size()), boxes);
    return {reinterpret_cast<LightDrift*>(staging_.reserve(count * sizeof(LightDrift))), count};
}

void DriftLights::upload() {
    if (lights_ == 0) return;
    const std::size_t bytes = lights_ * sizeof(LightDrift);
    gpu_.queue.enqueueWriteBuffer(drifts_.reserve(lights_), CL_FALSE, 0, bytes,
                                  staging_.reserve(bytes));
}

void DriftLights::order(double seconds, StageTimer& timer) {
    if (lights_ == 0) return;
    const auto count = static_cast<uint>(lights_);
    const std::size_t walkers = static_cast<std::size_t>(tuning_.cull_chunks) *
                                static_cast<std::size_t>(tuning_.cull_group);
    const auto chunks = static_cast<uint>(
        std::clamp<std::size_t>(lights_ / kLeastChunk, 1, std::max<std::size_t>(walkers, 1)));
    const WorkSize by_chunk = items(chunks, tuning_.light_group);
    const DeviceArray<uint> counts = counts_.reserve(kDigits * chunks);
    const DeviceArray<uint> offsets = offsets_.reserve(kDigits * chunks + 1);
    DeviceArray<std::uint64_t> from = order_.reserve(lights_), to = unsorted_.reserve(lights_);
    keys_.enqueue(items(lights_, tuning_.light_group), timer, drifts_.get(), count, boxes_.get(),
                  elapsed(seconds), from.buffer());
    for (uint shift = 0; shift < 32; shift += kDigitBits) {  // an even number of passes
        count_.enqueue(by_chunk, timer, from.buffer(), count, chunks, shift, counts);
        prefix_sum_.enqueue(counts, static_cast<uint>(kDigits) * chunks, offsets, timer);
        scatter_.enqueue(by_chunk, timer, from.buffer(), count, chunks, shift, offsets,
                         to.buffer());
        std::swap(from, to);
    }
    // Moves whole rows, whatever they hold.
    permute_.enqueue(items(lights_, tuning_.light_group), timer, drifts_.get().buffer(), count,
                     from.buffer(), ordered_.reserve(lights_).buffer());
}

void DriftLights::place(const DeviceArray<WorldLight>& world, std::size_t first, double seconds,
                        StageTimer& timer) {
    if (lights_ == 0) return;
    place_.enqueue(items(lights_, tuning_.light_group), timer, ordered_.get(),
                   static_cast<uint>(lights_), boxes_.get(), elapsed(seconds),
                   static_cast<uint>(first), world);
}

std::vector<std::uint32_t> DriftLights::download_order() const {
    std::vector<std::uint32_t> out;
    if (lights_ == 0) return out;
    out.reserve(lights_);
    for (const std::uint64_t pair : download(gpu_, order_.get())) out.push_back(high_word(pair));
    return out;
}

}  // namespace kilolux
