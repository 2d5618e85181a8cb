// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/count_texels.h"

namespace kilolux {
namespace {

constexpr std::string_view kCountTexelsStage = "count_texels";

cl::Program program_of(const Gpu& gpu, const Tuning& tuning, const SurfaceFeatures& surfaces) {
    BuildOptions options;
    define_surfaces(options, surfaces, tuning);
    return build_program(gpu, kCountTexelsStage, options);
}

}  // namespace

CountTexels::CountTexels(const Gpu& gpu, const Tuning& tuning, const SurfaceFeatures& surfaces)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu, program_of(gpu, tuning, surfaces), kCountTexelsStage, "count_texels"),
      counts_(gpu, kCountTexelsStage) {}

DeviceArray<uint> CountTexels::enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                                       const View& view, StageTimer& timer) {
    const DeviceArray<uint> counts = counts_.reserve(std::size_t{view.stride} * view.height);
    kernel_.enqueue(pixel_items(view, gpu_.info.lane_width, tuning_.shade_rows), timer, ids, view,
                    scene.instances, scene.instance_blocks, scene.meshes, scene.vertices,
                    scene.indices, scene.materials, scene.textures, scene.texels, counts);
    return counts;
}

}  // namespace kilolux
