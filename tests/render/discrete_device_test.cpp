// SPDX-License-Identifier: Apache-2.0
// Paths for a device with memory of its own (staged uploads and read-backs, two lanes, a GPU's
// kernels and groups), tested by treating the CPU's device as one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "host/render/plan/kernel_choice.h"
#include "tests/support/environment_variable.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

RenderSettings settings_with(Geometry geometry) {
    RenderSettings settings = small_settings(67, 41, 100);
    settings.geometry = geometry;
    settings.anisotropy = 1;
    settings.bloom = 0.1f;
    settings.want.shown_light = true;
    settings.want.aovs = {"depth", "normal", "position"};
    return settings;
}

// Kernels differ by one unit in the last place in rounding a reciprocal root: 1e-5 covers the sum
// over a hundred lights.
void expect_close(const std::vector<float>& found, const std::vector<float>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    ASSERT_FALSE(expected.empty());
    const double most = std::ranges::max(expected);
    for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_NEAR(found[i], expected[i], 1e-5 * most) << i;
    }
}

void expect_same_picture(const Scene& scene, const RenderSettings& settings) {
    const Frame host = render_once(scene, settings);
    const EnvironmentVariable as_gpu("KILOLUX_DEVICE_KIND", "gpu");
    const DeviceInfo device = describe(choose_device(settings.device));
    ASSERT_FALSE(device.is_cpu);
    ASSERT_EQ(device.lane_width, 2);
    Renderer renderer(scene, settings);
    const Frame first = renderer.render(first_camera(scene), 0.0);
    const Frame again = renderer.render(first_camera(scene), 0.0);
    EXPECT_EQ(first.radiance, again.radiance) << "a second frame stages into the same memory";
    expect_close(first.radiance, host.radiance);
    expect_close(first.shown_light, host.shown_light);
    ASSERT_EQ(first.aovs.size(), host.aovs.size());
    for (std::size_t i = 0; i < host.aovs.size(); ++i) {
        expect_close(first.aovs[i].values, host.aovs[i].values);
    }
    int codes = 0;
    ASSERT_EQ(first.display.size(), host.display.size());
    for (std::size_t i = 0; i < host.display.size(); ++i) {
        codes = std::max(codes, std::abs(int{first.display[i]} - int{host.display[i]}));
    }
    EXPECT_LE(codes, 1);
    RenderSettings every = settings;
    every.renderer = RendererKind::deferred_all;
    renderer.change(every);
    EXPECT_EQ(renderer.render(first_camera(scene), 0.0).radiance, first.radiance);
}

TEST(DiscreteDevice, PlanesAreUploaded) {
    expect_same_picture(grid_with_every_light(), settings_with(Geometry::planes));
}

TEST(DiscreteDevice, IdsAreUploaded) {
    expect_same_picture(grid_with_every_light(), settings_with(Geometry::ids));
}

TEST(DiscreteDevice, ComputeUploadsNothingButTheScene) {
    expect_same_picture(grid_with_every_light(), settings_with(Geometry::compute));
}

TEST(DiscreteDevice, CastsShadows) {
    RenderSettings settings = settings_with(Geometry::ids);
    settings.shadows = Shadows::exact;
    expect_same_picture(grid_with_every_light(), settings);
}

TEST(DiscreteDevice, GivenLanesAndRowsHoldForEveryModel) {
    const EnvironmentVariable as_gpu("KILOLUX_DEVICE_KIND", "gpu");
    const EnvironmentVariable tuned("KILOLUX_SHIPPED_TUNING", "H200");
    const DeviceInfo device = describe(choose_device(RenderSettings().device));
    ASSERT_GT(choose_tuning(device, {}).tuning.pbr_lanes, 0) << "PBR has lanes of its own there";
    RenderSettings settings = settings_with(Geometry::compute);
    const Frame usual = render_once(grid_with_every_light(), settings);
    settings.kernels.lanes = 4;
    EXPECT_EQ(choose_tuning(device, settings.kernels).lanes, 4);
    EXPECT_EQ(choose_tuning(device, settings.kernels).tuning.pbr_lanes, 0);
    settings.kernels.group_height = 3;  // does not divide a tile
    EXPECT_EQ(render_once(grid_with_every_light(), settings).radiance, usual.radiance);
}

TEST(DiscreteDevice, FollowsMovingLights) {
    const Scene scene = make_generated_scene("grid");
    const RenderSettings settings = settings_with(Geometry::ids);
    const EnvironmentVariable as_gpu("KILOLUX_DEVICE_KIND", "gpu");
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame still = renderer.render(camera, 0.0), moved = renderer.render(camera, 0.5);
    EXPECT_NE(still.radiance, moved.radiance);
    EXPECT_EQ(renderer.render(camera, 0.0).radiance, still.radiance);
    EXPECT_EQ(moved.radiance, render_once(scene, settings, 0.5).radiance);
}

}  // namespace
}  // namespace kilolux
