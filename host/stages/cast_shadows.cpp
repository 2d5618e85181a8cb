// SPDX-License-Identifier: Apache-2.0
#include "host/stages/cast_shadows.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "cast_shadows";
// Work-groups that share a tile's lights: the longest lists decide when the last group ends.
constexpr int kSplit = 4;
constexpr std::size_t kFirstWords = std::size_t{1} << 18;  // that there is room for from the start

// PoCL 3.1 reads through wild pointers in the work-group form, which loses values across barriers;
// oclgrind finds no fault in it. A CPU would not gain by it.
Tuning usable(Tuning tuning, const DeviceInfo& device) {
    if (device.is_cpu && device.platform != "Oclgrind") tuning.shadow_group = 1;
    return tuning;
}

cl::Program program_of(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                       const SurfaceFeatures& surfaces) {
    BuildOptions options = feature_options(features);
    define_casters(options, surfaces, tuning);
    options.define("DRAWN_ONLY", features.sampled_shadows);
    if (tuning.shadow_group == 1) return build_program(gpu, "cast_shadows_by_item", options);
    options.define("GROUP", tuning.shadow_group).define("SPLIT", kSplit);
    return build_program(gpu.with_lanes(1), "cast_shadows_by_group", options);
}

}  // namespace

CastShadows::CastShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                         const SurfaceFeatures& surfaces)
    : tuning_(usable(tuning, gpu.info)),
      program_(program_of(gpu, tuning_, features, surfaces)),
      reserve_(gpu, program_, kStage, "cast_shadows_reserve"),
      cast_(gpu, program_, kStage, "cast_shadows"),
      words_(gpu, tuning, kStage, sizeof(uint)) {
    words_.reserve(kFirstWords);
}

ShadowWords CastShadows::reserve(const PreparedLights& lights, const ActiveClusters& clusters,
                                 StageTimer& timer) {
    const uint tiles = clusters.tile_count;
    reserve_.enqueue(items(tiles, tuning_.light_group), timer, tiles, lights.directional_count,
                     clusters.offsets, clusters.clusters, clusters.capacity, words_.counts(tiles));
    ShadowWords out;
    out.offsets = words_.enqueue_offsets(tiles, timer);
    words_.fits(words_.read_total());
    out.words = words_.entries<uint>();
    return out;
}

void CastShadows::enqueue(const ShadowInput& input, const PreparedLights& lights,
                          const ActiveClusters& clusters, const RefinedLists& lists,
                          const View& view, const ShadowWords& words, StageTimer& timer) {
    const uint tiles = clusters.tile_count;
    const ShadowCasters& c = input.casters;
    const std::size_t split = tuning_.shadow_group == 1 ? 1 : kSplit;
    cast_.enqueue(groups(tiles * split, tuning_.shadow_group), timer, view, input.view,
                  input.origins, lights.bounds, lights.directional, lights.directional_count,
                  clusters.offsets, clusters.clusters, clusters.capacity, clusters.order,
                  lists.lists, words.offsets, c.nodes, c.triangles, c.masked, c.materials,
                  c.textures, c.texels, words.words);
}

}  // namespace kilolux
