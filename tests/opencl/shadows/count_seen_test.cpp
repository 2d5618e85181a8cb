// SPDX-License-Identifier: Apache-2.0
// Lights that pixels face, where float64 is not needed to tell.
#include "host/stages/shadows/count_seen.h"

#include <gtest/gtest.h>

#include "host/certify/synthetic/host_lists.h"
#include "host/stages/shadows/cast_shadows.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

template <typename T>
void fill_plane(Synthetic& image, uint plane, T value) {
    T* first = image.plane<T>(plane);
    std::fill(first, first + image.view.stride * image.view.height, value);
}

// A wall at z = -5 that faces the eye exactly.
Synthetic wall(const KernelFeatures& features) {
    ViewShape shape;
    shape.width = shape.height = 16;
    shape.rotated = false;
    Synthetic image = make_synthetic(make_view(shape), features, slanted_depth(5, 5, 16));
    fill_plane(image, PLANE_POSITION_X + 2, -5.0f);
    fill_plane(image, PLANE_NORMAL_X, 0.0f);
    fill_plane(image, PLANE_NORMAL_X + 1, 0.0f);
    fill_plane(image, PLANE_NORMAL_X + 2, 1.0f);
    return image;
}

// A light in the plane adds nothing, so no pixel faces it; nor one behind.
TEST(CountSeen, ALightInASurfacesPlaneIsNotFaced) {
    const Gpu gpu = test_gpu();
    const Tuning tuning = default_tuning(gpu.info);
    KernelFeatures features;
    features.gbuffer = GBUFFER_FULL;
    features.shading = SHADING_LAMBERT;
    features.directional_lights = features.shadows = true;
    const GBuffer gbuffer = upload_gbuffer(gpu, wall(features));
    const ClusterGrid grid = make_cluster_grid({1, 1, 1, 1.0f, 30.0f}, 16, 16);
    const LightInput lights =
        upload_lights(gpu,
                      {point_light({0.25, 0, -5}, 100), point_light({0, 1, -4}, 100),
                       point_light({0, 1, -6}, 100)},
                      {{{1, 0, 0, 0}, {1, 1, 1, 0}}, {{0, 0, 1, 0}, {1, 1, 1, 0}}});
    StageTimer timer;
    LightLists stages(gpu, tuning, features);
    const ListedLights lists = stages.run(lights, gbuffer, grid, timer);
    CastShadows cast(gpu, tuning, features, {});
    const ShadowWords words = cast.reserve(lists.lights, lists.clusters, timer);
    CountSeen count(gpu, tuning, features);
    const SeenCounts counts = count.enqueue(lists.at(gbuffer), words, timer);
    const auto facing = download<uint>(gpu, counts.facing, 16 * 16);
    for (const uint faced : facing) ASSERT_EQ(faced, 2u) << "one light, and one direction";
}

}  // namespace
}  // namespace kilolux
