// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/drift_lights.h"

#include <algorithm>

#include "host/stages/lights/move_lights.h"

namespace kilolux {
namespace {

constexpr uint kDigitBits = 8;  // of kernels/lights/drift_lights.cl
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr std::size_t kLeastChunk = 256;  // lights: as many as a chunk has counters

}  // namespace

DriftLights::DriftLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, "drift_lights")),
      keys_(gpu, program_, kMoveLightsStage, "drift_keys"),
      count_(gpu, program_, kMoveLightsStage, "drift_count"),
      scatter_(gpu, program_, kMoveLightsStage, "drift_scatter"),
      paths_(gpu, program_, kMoveLightsStage, "drift_paths"),
      place_(gpu, program_, kMoveLightsStage, "drift_lights"),
      prefix_sum_(gpu, tuning, kMoveLightsStage),
      swarm_(gpu, "lights"),
      drifts_(gpu, "lights"),
      order_(gpu, "lights"),
      unsorted_(gpu, "lights"),
      counts_(gpu, "lights"),
      offsets_(gpu, "lights") {}

void DriftLights::set(const LightSwarm& swarm, std::size_t count) {
    lights_ = count;
    kilolux::upload<LightSwarm>(gpu_, swarm_.reserve(1), {&swarm, 1});
}

void DriftLights::order(const DriftTime& time, StageTimer& timer) {
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
    keys_.enqueue(items(lights_, tuning_.light_group), timer, swarm_.get(), count, time,
                  from.buffer());
    for (uint shift = 0; shift < 32; shift += kDigitBits) {  // an even number of passes
        count_.enqueue(by_chunk, timer, from.buffer(), count, chunks, shift, counts);
        prefix_sum_.enqueue(counts, static_cast<uint>(kDigits) * chunks, offsets, timer);
        scatter_.enqueue(by_chunk, timer, from.buffer(), count, chunks, shift, offsets,
                         to.buffer());
        std::swap(from, to);
    }
    paths_.enqueue(items(lights_, tuning_.light_group), timer, swarm_.get(), count, from.buffer(),
                   drifts_.reserve(lights_));
}

void DriftLights::place(const DeviceArray<WorldLight>& world, std::size_t first,
                        const DriftTime& time, StageTimer& timer) {
    if (lights_ == 0) return;
    place_.enqueue(items(lights_, tuning_.light_group), timer, swarm_.get(),
                   static_cast<uint>(lights_), drifts_.get(), time, static_cast<uint>(first),
                   world);
}

std::vector<std::uint32_t> DriftLights::download_order() const {
    std::vector<std::uint32_t> out;
    if (lights_ == 0) return out;
    out.reserve(lights_);
    for (const std::uint64_t pair : download(gpu_, order_.get())) out.push_back(high_half(pair));
    return out;
}

}  // namespace kilolux
