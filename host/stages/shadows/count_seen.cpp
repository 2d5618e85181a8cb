// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/count_seen.h"

namespace kilolux {

CountSeen::CountSeen(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      kernel_(gpu, build_program(gpu, kCountSeenStage, feature_options(features)), kCountSeenStage,
              "count_seen"),
      facing_(gpu, kCountSeenStage),
      seen_(gpu, kCountSeenStage) {}

SeenCounts CountSeen::enqueue(const LitPixels& lit, const ShadowWords& shadows, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    const std::size_t pixels = std::size_t{view.stride} * view.height;
    SeenCounts out{facing_.reserve(pixels), seen_.reserve(pixels)};
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, lit, shadows, out.facing,
                    out.seen);
    return out;
}

}  // namespace kilolux
