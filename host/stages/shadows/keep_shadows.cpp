// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/keep_shadows.h"

#include <cstring>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr int kItems = 8;  // for each tile

}  // namespace

KeepShadows::Copies::Copies(const Gpu& gpu, std::string_view stage)
    : bounds(gpu, stage),
      directional(gpu, stage),
      clusters(gpu, stage),
      lists(gpu, stage),
      offsets(gpu, stage),
      words(gpu, stage) {}

KeepShadows::KeepShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                         std::string_view stage)
    : gpu_(gpu),
      tuning_(tuning),
      stage_(stage),
      kernel_(gpu,
              build_program(gpu, "keep_shadows",
                            feature_options(features).define("KEEP_ITEMS", kItems)),
              stage, "keep_shadows"),
      kept_(gpu, stage) {}

bool KeepShadows::has_room(std::uint64_t bytes) const {
    if (!gpu_.budget) return true;
    const std::uint64_t used = gpu_.budget->used, limit = gpu_.budget->limit;
    return used <= limit && 2 * bytes <= limit - used;
}

template <typename T>
DeviceArray<T> KeepShadows::copy(GrowingArray<T>& to, const DeviceArray<T>& from,
                                 std::size_t count) {
    const DeviceArray<T> out = to.reserve(count);
    if (count > 0) gpu_.queue.enqueueCopyBuffer(from, out, 0, 0, count * sizeof(T));
    return out;
}

ShadowsBefore KeepShadows::copy(const LitPixels& lit, const ShadowWords& shadows,
                                std::uint64_t words) {
    const PreparedLights& lights = lit.lights;
    ShadowsBefore out;
    out.light_count = lights.count;
    out.directional_count = lights.directional_count;
    out.bounds = copy(copies_->bounds, lights.bounds, lights.count);
    out.directional = copy(copies_->directional, lights.directional, lights.directional_count);
    out.clusters = copy(copies_->clusters, lit.clusters.clusters, lit.clusters.clusters.count());
    out.lists = copy(copies_->lists, lit.refined.lists, lit.refined.lists.count());
    out.shadows.offsets =
        copy(copies_->offsets, shadows.offsets, std::size_t{lit.clusters.tile_count} + 1);
    out.shadows.words = copy(copies_->words, shadows.words, words);
    return out;
}

void KeepShadows::save(const LitPixels& lit, const ShadowWords& shadows, std::uint64_t words) {
    before_.reset();
    if (!copies_) {
        const std::uint64_t bytes = lit.lights.count * sizeof(float4) +
                                    lit.clusters.clusters.count() * sizeof(ActiveCluster) +
                                    lit.refined.lists.count() + words * sizeof(uint);
        if (!has_room(bytes)) return;
        copies_.emplace(gpu_, stage_);
    }
    try {
        before_ = copy(lit, shadows, words);
    } catch (const Error&) {
        return forget();  // no room
    }
    gbuffer_ = lit.gbuffer.version;
    grid_ = lit.clusters.grid;
}

void KeepShadows::forget() {
    before_.reset();
    copies_.reset();
}

DeviceArray<uint> KeepShadows::enqueue(const LitPixels& lit, const ShadowWords& shadows,
                                       std::uint64_t words, StageTimer& timer) {
    const bool is_same = before_ && gbuffer_ != 0 && gbuffer_ == lit.gbuffer.version &&
                         std::memcmp(&grid_, &lit.clusters.grid, sizeof grid_) == 0;
    if (!is_same || words == 0) return {};
    const std::size_t size = (words + 31) / 32;
    const DeviceArray<uint> kept = kept_.reserve(size);
    gpu_.queue.enqueueFillBuffer(kept.buffer(), cl_uint{0}, 0, size * sizeof(uint));
    kernel_.enqueue(items(std::size_t{lit.clusters.tile_count} * kItems, tuning_.light_group),
                    timer, lit, shadows, *before_, lit.lights.index_before, kept);
    return kept;
}

}  // namespace kilolux
