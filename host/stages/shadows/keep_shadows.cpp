// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/keep_shadows.h"

#include <cstring>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr int kItems = 8;  // for each tile

std::size_t list_bytes(const KernelFeatures& features, const PairCounts& counts) {
    return counts.refine_tests * light_index_bytes(features);
}

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
    : gpu_(gpu), tuning_(tuning), features_(features), stage_(stage), kept_(gpu, stage) {}

bool KeepShadows::has_room(std::uint64_t bytes) const {
    if (!gpu_.budget) return true;
    const std::uint64_t used = gpu_.budget->used, limit = gpu_.budget->limit;
    return used <= limit && 2 * bytes <= limit - used;
}

ShadowsBefore KeepShadows::copy(const LitPixels& lit, const CountedWords& words,
                                const PairCounts& counts, StageTimer& timer) {
    const auto copied = [&](auto& to, const auto& from, std::size_t count) {
        const auto out = to.reserve(count);
        if (count == 0) return out;
        const std::size_t bytes = count * sizeof(typename decltype(out)::value_type);
        cl::Event done;
        gpu_.queue.enqueueCopyBuffer(from, out, 0, 0, bytes, nullptr, &done);
        timer.record(stage_, done);
        return out;
    };
    const PreparedLights& lights = lit.lights;
    const std::size_t tiles = lit.clusters.tile_count;
    ShadowsBefore out;
    out.light_count = lights.count;
    out.directional_count = lights.directional_count;
    out.bounds = copied(copies_->bounds, lights.bounds, lights.count);
    out.directional = copied(copies_->directional, lights.directional, lights.directional_count);
    out.clusters = copied(copies_->clusters, lit.clusters.clusters, counts.active_clusters);
    out.lists = copied(copies_->lists, lit.refined.lists, list_bytes(features_, counts));
    out.shadows.offsets = copied(copies_->offsets, words.shadows.offsets, tiles + 1);
    out.shadows.words = copied(copies_->words, words.shadows.words, words.count);
    return out;
}

void KeepShadows::save(const LitPixels& lit, const CountedWords& words, const PairCounts& counts,
                       StageTimer& timer) {
    before_.reset();
    if (!copies_) {
        const std::uint64_t bytes = lit.lights.count * sizeof(float4) +
                                    counts.active_clusters * sizeof(ActiveCluster) +
                                    list_bytes(features_, counts) + words.count * sizeof(uint);
        if (!has_room(bytes)) return;
        copies_.emplace(gpu_, stage_);
    }
    try {
        before_ = copy(lit, words, counts, timer);
    } catch (const Error&) {
        return forget();  // no room
    } catch (const cl::Error&) {
        return forget();
    }
    gbuffer_version_ = lit.gbuffer.version;
    grid_ = lit.clusters.grid;
    if (kernel_) return;
    BuildOptions options = feature_options(features_);
    options.define("KEEP_ITEMS", kItems);
    kernel_.emplace(gpu_, build_program(gpu_, "keep_shadows", options), stage_, "keep_shadows");
}

void KeepShadows::forget() {
    before_.reset();
    copies_.reset();
}

DeviceArray<uint> KeepShadows::enqueue(const LitPixels& lit, const ShadowWords& words,
                                       StageTimer& timer) {
    const bool is_same = before_ && gbuffer_version_ != 0 &&
                         gbuffer_version_ == lit.gbuffer.version &&
                         std::memcmp(&grid_, &lit.clusters.grid, sizeof grid_) == 0;
    if (!is_same) return {};
    const std::size_t size = (words.capacity + std::size_t{31}) / 32;
    const DeviceArray<uint> kept = kept_.reserve(size);
    cl::Event cleared;
    gpu_.queue.enqueueFillBuffer(kept.buffer(), cl_uint{0}, 0, size * sizeof(uint), nullptr,
                                 &cleared);
    timer.record(stage_, cleared);
    kernel_->enqueue(items(std::size_t{lit.clusters.tile_count} * kItems, tuning_.light_group),
                     timer, lit, words, *before_, lit.lights.index_before, kept);
    return kept;
}

}  // namespace kilolux
