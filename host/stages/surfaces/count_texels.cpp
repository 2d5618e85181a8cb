// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/count_texels.h"

namespace kilolux {
namespace {

KernelProgram texel_count_program(const Gpu& gpu, const Tuning& tuning,
                                  const SurfaceFeatures& surfaces) {
    BuildOptions options;
    define_surfaces(options, surfaces, tuning);
    return build_program(gpu, kCountTexelsStage, options);
}

}  // namespace

CountTexels::CountTexels(const Gpu& gpu, const Tuning& tuning, const SurfaceFeatures& surfaces)
    : tuning_(tuning),
      kernel_(gpu, texel_count_program(gpu, tuning, surfaces), kCountTexelsStage, "count_texels"),
      counts_(gpu, kCountTexelsStage) {}

DeviceArray<uint> CountTexels::enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                                       const View& view, StageTimer& timer) {
    DeviceArray<uint> counts = counts_.reserve(std::size_t{view.stride} * view.height);
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, ids, view, scene, counts);
    return counts;
}

}  // namespace kilolux
