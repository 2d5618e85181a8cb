// SPDX-License-Identifier: Apache-2.0
// A wall before an eye whose near plane is oblique shows where the plane lies before it.
#include <gtest/gtest.h>

#include "host/surfaces/surface_scene.h"
#include "host/surfaces/triangle_ids.h"
#include "tests/support/quad_scene.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr int kObliqueSize = 32;

// The ids of the pixels of a wall 2 m before the eye.
std::vector<uint> wall_ids(const View& oblique, const Camera& camera, int group) {
    const Scene scene = quad_scene(8.0f);
    const Gpu gpu = test_gpu(group > 1 ? 1 : 0);
    Tuning tuning = default_tuning(gpu.info);
    tuning.raster_group = group;
    if (group > 1) tuning.raster_tile_width = tuning.raster_tile_height = 32;
    const SurfaceFeatures features = surface_features(scene, {}, 1);
    SurfaceScene surfaces(gpu, tuning, scene, features);
    TriangleIds ids(gpu, tuning, scene, features);
    const std::vector<Draw> draws = ids.visible(camera, kObliqueSize, kObliqueSize);
    StageTimer timer;
    return download(gpu, ids.draw(surfaces.at(draws), draws, oblique, timer));
}

TEST(ObliqueNearPlane, ShowsWhatLiesBehindIt) {
    const Camera camera = front_camera(2.0);
    // 1 / depth of the near plane is 0.4 + 0.01 (i + 0.5) in the i-th column or row, or falls so.
    for (const float step : {0.01f, -0.01f}) {
        const float first = step > 0.0f ? 0.0f : 0.32f;
        for (const bool by_row : {false, true}) {
            View view = view_of(camera, kObliqueSize, kObliqueSize);
            view.depth = {0.4f, by_row ? 0.0f : step, by_row ? step : 0.0f, first};
            for (const int group : {1, 64}) {
                const std::vector<uint> ids = wall_ids(view, camera, group);
                for (uint y = 0; y < kObliqueSize; ++y) {
                    for (uint x = 0; x < kObliqueSize; ++x) {
                        const double place = (by_row ? y : x) + 0.5;
                        const bool behind = 0.4 + first + step * place > 0.5;
                        ASSERT_EQ(ids[y * view.stride + x] != 0, behind)
                            << x << ", " << y << ", step " << step << ", group " << group;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace kilolux
