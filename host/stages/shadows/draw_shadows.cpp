// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shadows/draw_shadows.h"

#include "host/stages/shading/instruction_counts.h"

namespace kilolux {

DrawShadows::DrawShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : resources_(gpu, tuning, features, kDrawShadowsStage),
      program_(build_program(gpu, kDrawShadowsStage, resources_.options())),
      clear_(gpu, program_, kDrawShadowsStage, "draw_shadows_clear"),
      draw_(gpu, program_, kDrawShadowsStage, "draw_shadows") {}

void DrawShadows::clear(const ActiveClusters& clusters, const ShadowWords& words,
                        StageTimer& timer) {
    constexpr std::size_t kClearItems = 16384;
    clear_.enqueue(items(kClearItems, 1), timer, words, clusters.tile_count);
}

void DrawShadows::enqueue(const LitPixels& lit, const ShadowWords& words,
                          const ShadowSamples& samples, StageTimer& timer) {
    LitPixels stored = lit;
    stored.lights = resources_.stored_lights(lit.lights, timer);
    draw_.enqueue(resources_.work_size(draw_, lit.gbuffer.view), timer, stored, words, samples);
}

// Evaluates each light of a pixel's list alone; which of those with a size it evaluates is not
// counted.
StageWork draw_shadows_work(const StageCounts& c) {
    return {.bytes_read = listed_surface_bytes(c) + kRadianceBytes * c.surface_pixels,
            .bytes_written = kWordBytes * c.shadow_words,
            .instructions = c.kernels.area_lights ? InstructionCounts{} : shading_instructions(c),
            .launches = 2};
}

}  // namespace kilolux
