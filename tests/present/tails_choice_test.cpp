// SPDX-License-Identifier: Apache-2.0
// What --tails auto keeps of the light of many lights without a range, and what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "host/scene/lights/bounded_loss.h"
#include "present/cli/option_builder.h"
#include "present/cli/options.h"
#include "present/cli/scene_choice.h"
#include "tests/support/lit_hall.h"
#include "tests/support/messages.h"
#include "tests/support/render_fixture.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

class TailsChoice : public testing::Test {
 protected:
    void write(const Scene& scene) { write_scene(scene, folder_ / "hall.glb"); }

    // Options as `kilolux render hall.glb` with more words has them; the lines of its lights.
    std::string open(const std::string& more) {
        CLI::App app;
        options_ = {};
        options_.shows_environment = true;
        options_.compares_renderers = compares_renderers_;
        add_options(app, options_);
        app.parse((folder_ / "hall.glb").string() + " -q --ambient 0 --resolution 48,27 " + more);
        AnimatedScene opened = open_animated_scene(options_);
        std::string line = light_scene(options_, opened);
        scene_.emplace(std::move(opened).take());
        return line;
    }

    double light(const std::string& more) {
        open(more);
        options_.settings.opened = opened_device(options_.settings.device);
        const Frame frame =
            Renderer(*scene_, options_.settings).render(choose_camera(options_, *scene_), 0.0);
        return std::accumulate(frame.radiance.begin(), frame.radiance.end(), 0.0);
    }

    TemporaryFolder folder_;
    SharedOptions options_;
    bool compares_renderers_ = false;
    std::optional<Scene> scene_;
};

TEST_F(TailsChoice, AutomaticOnesKeepNineTenthsOfTheLightWhereverOneLooks) {
    const std::string end = " --camera-position 0,0,180 --camera-focal-point 0,0,200";
    const std::string middle = " --camera-position 0,0,-50 --camera-focal-point 0,-1,0";
    const std::pair<int, float> cases[] = {{128, 1.2f},   {129, 1.2f},    {129, 10.0f},
                                           {129, 60.0f},  {1000, 0.15f},  {1000, 10.0f},
                                           {1000, 60.0f}, {1000, 2000.0f}};
    for (const auto& [count, intensity] : cases) {
        write(lit_hall(count, intensity));
        for (const std::string& camera : {end, middle}) {
            const double exact = light("--tails exact" + camera);
            ASSERT_GT(exact, 0.0);
            EXPECT_NEAR(light(camera) / exact, 1.0, 0.1)
                << count << " of " << intensity << " cd" << camera << " " << open(camera);
        }
    }
}

TEST_F(TailsChoice, TheLineNamesWhatTheSumLoses) {
    write(lit_hall(129, 2000.0f));
    EXPECT_TRUE(contains(open(""),
                         "tails   bounded (automatic): 129 lights without a range end where each "
                         "adds 0.00391 of radiance; their sum loses up to about "))
        << open("");
    EXPECT_TRUE(contains(open("--tails bounded --range-budget 1"),
                         "adds 1 of radiance; their sum loses up to about 100 % at a point "
                         "(--aov error-bound), with --tails exact nothing"))
        << open("--tails bounded --range-budget 1");
}

// What a tree cannot light: shadows, forward renderers, blended surfaces, sweeps of renderers.
class LongerRanges : public TailsChoice,
                     public testing::WithParamInterface<std::tuple<int, const char*>> {};

TEST_P(LongerRanges, KeepNineTenthsOfTheSum) {
    const auto& [count, option] = GetParam();
    write(lit_hall(count, 1.0f));
    const std::string camera = " --camera-position 0,0,180 --camera-focal-point 0,0,200 ";
    const double exact = light("--tails exact" + camera + option);
    testing::internal::CaptureStderr();
    EXPECT_NEAR(light(camera + option) / exact, 1.0, 0.1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(options_.settings.tails, Tails::bounded);
    EXPECT_LT(options_.settings.range_budget, kDefaultRangeBudget);
    const double lost =
        bounded_loss(scene_->lights, resting_bounds(*scene_), options_.settings.range_budget);
    EXPECT_LE(lost, kMostLost);
    EXPECT_GT(
        bounded_loss(scene_->lights, resting_bounds(*scene_), 2.0 * options_.settings.range_budget),
        kMostLost)
        << "ranges are no longer than they must be";
}

INSTANTIATE_TEST_SUITE_P(All, LongerRanges,
                         testing::Combine(testing::Values(129, 1000),
                                          testing::Values("--shadows exact",
                                                          "--renderer forward-plus")));

TEST_F(TailsChoice, BlendedSurfacesGetLongerRanges) {
    Scene scene = lit_hall(200, 1.0f);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    write(scene);
    EXPECT_TRUE(contains(open(""), "tails   bounded (automatic)")) << open("");
    EXPECT_LE(bounded_loss(scene_->lights, resting_bounds(*scene_), options_.settings.range_budget),
              kMostLost);
}

TEST_F(TailsChoice, SweepsOfRenderersGetLongerRanges) {
    write(lit_hall(200, 1.0f));
    compares_renderers_ = true;
    open("");
    EXPECT_EQ(options_.settings.tails, Tails::bounded);
    EXPECT_LE(bounded_loss(scene_->lights, resting_bounds(*scene_), options_.settings.range_budget),
              kMostLost);
}

// Ranges end where more lights would reach a point than a pixel can evaluate; then it is said.
TEST_F(TailsChoice, RangesOfTooManyLightsStayShortWithAWarning) {
    write(lit_hall(50'000, 1e-4f));
    testing::internal::CaptureStderr();
    const std::string line = open("--shadows exact");
    const std::string written = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(contains(line, "tails   bounded (automatic)")) << line;
    const std::string warning = "kilolux: warning: " + options_.scene +
                                ": lights without a range are cut off; up to about ";
    EXPECT_TRUE(written.starts_with(warning)) << written;
    EXPECT_EQ(std::ranges::count(written, '\n'), 1) << written;
}

}  // namespace
}  // namespace kilolux
