// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/keep_shadows.h"

#include <cstring>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr int kItems = 8;  // for each tile

}  // namespace

KeepShadows::KeepShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                         std::string_view stage)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu,
              build_program(gpu, "keep_shadows",
                            feature_options(features).define("KEEP_ITEMS", kItems)),
              stage, "keep_shadows"),
      bounds_(gpu, stage),
      directional_(gpu, stage),
      clusters_(gpu, stage),
      lists_(gpu, stage),
      offsets_(gpu, stage),
      words_(gpu, stage),
      kept_(gpu, stage) {}

template <typename T>
DeviceArray<T> KeepShadows::copy(GrowingArray<T>& to, const DeviceArray<T>& from,
                                 std::size_t count) {
    const DeviceArray<T> out = to.reserve(count);
    if (count > 0) {
        gpu_.queue.enqueueCopyBuffer(from, out, 0, 0, count * sizeof(T));
    }
    return out;
}

void KeepShadows::save(const LitPixels& lit, const ShadowWords& shadows, std::uint64_t words) {
    forget();
    const PreparedLights& lights = lit.lights;
    ShadowsBefore out;
    out.light_count = lights.count;
    out.directional_count = lights.directional_count;
    try {
        out.bounds = copy(bounds_, lights.bounds, lights.count);
        out.directional = copy(directional_, lights.directional, lights.directional_count);
        out.clusters = copy(clusters_, lit.clusters.clusters, lit.clusters.clusters.count());
        out.lists = copy(lists_, lit.refined.lists, lit.refined.lists.count());
        out.shadows.offsets =
            copy(offsets_, shadows.offsets, std::size_t{lit.clusters.tile_count} + 1);
        out.shadows.words = copy(words_, shadows.words, words);
    } catch (const Error&) {
        return;  // no room
    }
    before_ = std::move(out);
    gbuffer_ = lit.gbuffer.version;
    grid_ = lit.clusters.grid;
}

void KeepShadows::forget() { before_.reset(); }

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
