// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/triangle_ids.h"

#include <algorithm>

#include "host/gpu/repeat_until_fits.h"

namespace kilolux {
namespace {

Gpu with_raster_lanes(const Gpu& gpu, const Tuning& tuning) {
    return gpu.with_lanes(std::min(gpu.info.lane_width, tuning.raster_lanes));
}

}  // namespace

TriangleIds::TriangleIds(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                         const SurfaceFeatures& features)
    : scene_(scene),
      tuning_(tuning),
      draw_list_(scene),
      bin_(with_raster_lanes(gpu, tuning), tuning),
      raster_(with_raster_lanes(gpu, tuning), tuning, features) {}

std::vector<Draw> TriangleIds::visible(const Camera& camera, int width, int height,
                                       const OpenTiles* open) const {
    return draw_list_.visible(camera, width, height, false, DrawOrder::front_to_back, open);
}

// 1 for the raster's tiles that contain no open tile.
std::vector<std::uint8_t> TriangleIds::closed_tiles(const View& view, const OpenTiles* open) const {
    std::vector<std::uint8_t> out;
    if (open == nullptr) return out;
    const glm::dvec2 tile(tuning_.raster_tile_width, tuning_.raster_tile_height);
    const uint columns = (view.width + static_cast<uint>(tile.x) - 1) / static_cast<uint>(tile.x);
    for (uint i = 0; i < raster_tile_count(view, tuning_); ++i) {
        const glm::dvec2 least = glm::dvec2(i % columns, i / columns) * tile;
        out.push_back(open->touches(least, least + tile - 1.0) ? 0 : 1);
    }
    return out;
}

DeviceArray<uint> TriangleIds::enqueue(const SurfaceBuffers& scene, std::span<const Draw> draws,
                                       const View& view, StageTimer& timer, const OpenTiles* open) {
    triangles_ = drawn_triangles(draws, scene_);
    bin_.close_tiles(closed_tiles(view, open));
    return raster_.enqueue(scene, bin_.enqueue(scene, triangles_, view, timer), view, timer);
}

bool TriangleIds::fits() {
    pairs_ = bin_.pairs();
    return bin_.fits(pairs_);
}

DeviceArray<uint> TriangleIds::draw(const SurfaceBuffers& scene, std::span<const Draw> draws,
                                    const View& view, StageTimer& timer, const OpenTiles* open) {
    return repeat_until_fits(
        timer, [&] { return enqueue(scene, draws, view, timer, open); }, [&] { return fits(); });
}

}  // namespace kilolux
