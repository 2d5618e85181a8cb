// SPDX-License-Identifier: Apache-2.0
// The work of resolving, counted for its limit.
#include <gtest/gtest.h>

#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"

namespace kilolux {
namespace {

FrameStats stats_of(const char* name, bool counts) {
    const Scene scene = make_generated_scene(name, 1);
    RenderSettings settings;
    settings.width = 320;
    settings.height = 180;
    settings.lights.count = 20;
    settings.geometry = Geometry::compute;
    settings.want.counts = counts;
    return Renderer(scene, settings).render(camera_of(scene.cameras.at(0)), 0.0).stats;
}

TEST(SurfaceCounts, OnlyWhereAskedFor) {
    const FrameStats without = stats_of("atrium", false);
    EXPECT_EQ(without.texels + without.seen_triangles, 0u);
    const FrameStats with = stats_of("atrium", true);
    EXPECT_GT(with.seen_triangles, 1000u);
    EXPECT_LT(with.seen_triangles, with.triangles);
    // Four to eight texels for each texture of a pixel.
    EXPECT_GE(with.texels, 4 * with.surface_pixels);
    EXPECT_EQ(with.texels % 4, 0u);
}

TEST(SurfaceCounts, NoTexelsWithoutTextures) {
    const FrameStats stats = stats_of("plain", true);
    EXPECT_EQ(stats.texels, 0u);
    EXPECT_GT(stats.seen_triangles, 0u);
}

}  // namespace
}  // namespace kilolux
