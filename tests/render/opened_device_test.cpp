// SPDX-License-Identifier: Apache-2.0
// Renderers that share an open device share the programs built for it, and make the pictures of
// renderers that open their own.
#include <gtest/gtest.h>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

RenderSettings with_shading(Shading shading, std::shared_ptr<const Gpu> opened) {
    RenderSettings settings = small_settings();
    settings.shading = shading;
    settings.opened = std::move(opened);
    return settings;
}

TEST(OpenedDevice, SharesItsProgramsAndChangesNoBit) {
    const Scene scene = make_generated_scene("grid");
    const RenderSettings shared = small_settings();
    const Renderer first(scene, shared), second(scene, shared);
    EXPECT_EQ(first.gpu().programs, shared.opened->programs);
    EXPECT_EQ(first.gpu().programs, second.gpu().programs);
    EXPECT_NE(first.gpu().budget, second.gpu().budget) << "each has its own memory";
    const Frame frame = render_once(scene, with_shading(Shading::pbr, shared.opened));
    const Frame alone = render_once(scene, with_shading(Shading::pbr, nullptr));
    EXPECT_EQ(frame.radiance, alone.radiance);
    EXPECT_EQ(frame.display, alone.display);
}

TEST(OpenedDevice, OtherSettingsKeepTheDeviceAndItsPrograms) {
    const Scene scene = make_generated_scene("grid");
    Renderer renderer(scene, with_shading(Shading::lambert, nullptr));
    const std::shared_ptr<ProgramCache> programs = renderer.gpu().programs;
    renderer.change(with_shading(Shading::pbr, nullptr));
    EXPECT_EQ(renderer.gpu().programs, programs);
    const Frame frame = renderer.render(first_camera(scene), 0.0);
    const Frame alone = render_once(scene, with_shading(Shading::pbr, nullptr));
    EXPECT_EQ(frame.radiance, alone.radiance);
    EXPECT_EQ(frame.display, alone.display);
    RenderSettings one_lane = with_shading(Shading::pbr, nullptr);
    one_lane.kernels.lanes = 1;
    renderer.change(one_lane);
    EXPECT_EQ(renderer.gpu().programs, programs);
    EXPECT_EQ(renderer.device().lane_width, 1);
    if (!renderer.device().is_cpu) return;  // other devices' compilers may round otherwise
    EXPECT_EQ(renderer.render(first_camera(scene), 0.0).radiance, alone.radiance);
}

}  // namespace
}  // namespace kilolux
