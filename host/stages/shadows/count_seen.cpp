// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/count_seen.h"

namespace kilolux {
namespace {

constexpr std::string_view kCountSeenStage = "count_seen";

}  // namespace

CountSeen::CountSeen(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu, build_program(gpu, kCountSeenStage, feature_options(features)), kCountSeenStage,
              "count_seen"),
      facing_(gpu, kCountSeenStage),
      seen_(gpu, kCountSeenStage) {}

SeenCounts CountSeen::enqueue(const LitPixels& lit, const ShadowWords& shadows, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    const std::size_t pixels = std::size_t{view.stride} * view.height;
    const SeenCounts out{facing_.reserve(pixels), seen_.reserve(pixels)};
    kernel_.enqueue(pixel_items(view, gpu_.info.lane_width, tuning_.shade_rows), timer,
                    lit.gbuffer.bytes, lit.gbuffer.layout, view, lit.lights.directional,
                    lit.lights.directional_count, lit.lights.bounds, lit.grid, lit.clusters.offsets,
                    lit.clusters.clusters, lit.clusters.capacity, lit.clusters.order,
                    lit.refined.lists, shadows.offsets, shadows.words, out.facing, out.seen);
    return out;
}

}  // namespace kilolux
