// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/triangle_ids.h"

#include <algorithm>

namespace kilolux {
namespace {

Gpu with_raster_lanes(const Gpu& gpu, const Tuning& tuning) {
    return gpu.with_lanes(std::min(gpu.info.lane_width, tuning.raster_lanes));
}

}  // namespace

TriangleIds::TriangleIds(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                         const SurfaceFeatures& features)
    : scene_(scene),
      draw_list_(scene),
      bin_(with_raster_lanes(gpu, tuning), tuning),
      raster_(with_raster_lanes(gpu, tuning), tuning, features) {}

std::vector<Draw> TriangleIds::visible(const Camera& camera, int width, int height) const {
    return draw_list_.visible(camera, width, height, false, DrawOrder::front_to_back);
}

DeviceArray<uint> TriangleIds::enqueue(const SurfaceBuffers& scene, std::span<const Draw> draws,
                                       const View& view, StageTimer& timer) {
    triangles_ = drawn_triangles(draws, scene_);
    TriangleLists lists;
    do {
        lists = bin_.enqueue(scene, triangles_, view, timer);
        pairs_ = bin_.pairs();
    } while (!bin_.fits(pairs_));
    return raster_.enqueue(scene, lists, view, timer);
}

}  // namespace kilolux
