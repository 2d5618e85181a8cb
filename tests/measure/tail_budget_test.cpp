// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/tail_budget.h"

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

Scene bright_scene_without_ranges() {
    Scene scene = grid_with_every_light();
    for (SceneLight& light : scene.lights) light.range = 0.0f;
    return scene;
}

float worst_bound(const Scene& scene, RenderSettings settings) {
    settings.want.aovs = {"error-bound"};
    const Frame frame = render_once(scene, settings);
    return std::ranges::max(frame.aovs.front().values);
}

TEST(TailBudget, TheLargestThatKeepsWithinTheBound) {
    const Scene scene = bright_scene_without_ranges();
    const ReportView view{scene, first_camera(scene), 0.0};
    int pictures = 0;
    TailChoice choice = tails_within(view, small_settings(96, 54, 0), 0.2, [&] { ++pictures; });
    EXPECT_GT(pictures, 1);
    ASSERT_EQ(choice.settings.tails, Tails::bounded);
    EXPECT_LE(choice.bound, 0.2);
    EXPECT_EQ(worst_bound(scene, choice.settings), static_cast<float>(choice.bound));
    choice.settings.range_budget *= 2.0;
    EXPECT_GT(worst_bound(scene, choice.settings), 0.2);
}

TEST(TailBudget, NothingLostIsExact) {
    const Scene scene = bright_scene_without_ranges();
    const ReportView view{scene, first_camera(scene), 0.0};
    const TailChoice choice = tails_within(view, small_settings(48, 27, 0), 0.0, [] {});
    EXPECT_EQ(choice.settings.tails, Tails::exact);
    EXPECT_EQ(choice.bound, 0.0);
}

TEST(TailBudget, WithoutSuchLightsNoPictureIsMade) {
    const Scene scene = make_generated_scene("plain");
    const TailChoice choice = tails_within({scene, first_camera(scene), 0.0}, small_settings(), 0.1,
                                           [] { FAIL() << "a picture"; });
    EXPECT_EQ(choice.bound, 0.0);
}

}  // namespace
}  // namespace kilolux
