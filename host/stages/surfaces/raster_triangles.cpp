// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/raster_triangles.h"

#include "kernels/shared/surface_scene.h"

namespace kilolux {
namespace {

// NVIDIA's compiler uses so many registers for setting up that few work-groups fit on a
// multiprocessor, which then waits for memory: half of the time on an H200.
constexpr std::string_view kFewerRegisters = "-cl-nv-maxrregcount=64";

KernelProgram raster_program(const Gpu& gpu, const Tuning& tuning,
                             const SurfaceFeatures& features) {
    BuildOptions options;
    options.define("GROUP", tuning.raster_group).define("HAS_MASKS", features.masks);
    if (gpu.info.platform.starts_with("NVIDIA")) options.flag(kFewerRegisters);
    define_tiles(options, tuning);
    define_surfaces(options, alpha_features(features), tuning);
    return build_program(
        gpu, tuning.raster_group == 1 ? "raster_triangles_by_item" : "raster_triangles_by_group",
        options);
}

}  // namespace

RasterTriangles::RasterTriangles(const Gpu& gpu, const Tuning& tuning,
                                 const SurfaceFeatures& features)
    : tuning_(tuning),
      kernel_(gpu, raster_program(gpu, tuning, features), kRasterTrianglesStage,
              "raster_triangles"),
      ids_(gpu, kRasterTrianglesStage) {}

DeviceArray<uint> RasterTriangles::enqueue(const SurfaceBuffers& scene, const TriangleLists& lists,
                                           const View& view, StageTimer& timer) {
    DeviceArray<uint> ids = ids_.reserve(std::size_t{view.stride} * view.height);
    kernel_.enqueue(groups(lists.tile_count, tuning_.raster_group), timer, view, scene, lists, ids);
    return ids;
}

StageWork raster_triangles_work(const StageCounts& c) {
    return {.bytes_read = (sizeof(uint) + sizeof(RasterRow)) * c.triangle_pairs,
            .bytes_written = sizeof(uint) * c.pixels,
            .launches = 1};
}

}  // namespace kilolux
