// SPDX-License-Identifier: Apache-2.0
// What --tails auto keeps of the light of many lights without a range, and what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "host/scene/export/export_scene.h"
#include "present/cli/options.h"
#include "present/cli/scene_choice.h"
#include "tests/support/box_scene.h"
#include "tests/support/messages.h"
#include "tests/support/render_fixture.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

// A hall along z, lit but for its last metres.
Scene hall(int count, float intensity) {
    Scene scene = box_scene({40.0, 8.0, 400.0}, true);
    for (int i = 0; i < count; ++i) {
        const double t = (i + 0.5) / count;
        SceneLight light;
        light.position = {36.0 * std::fmod(7.3 * i / 11.0, 1.0) - 18.0, std::fmod(i / 5.0, 1.0),
                          -200.0 + 370.0 * t};
        light.intensity = glm::vec3(intensity);
        scene.lights.push_back(light);
    }
    return scene;
}

class TailsChoice : public testing::Test {
 protected:
    void write(const Scene& scene) {
        for (const ExportedFile& part : export_scene(scene, folder_ / "hall.glb").files) {
            write_text(folder_ / part.name, std::string(part.bytes.begin(), part.bytes.end()));
        }
    }

    // Options as `kilolux render hall.glb` with more words has them; the lines of its lights.
    std::string open(const std::string& more) {
        CLI::App app;
        options_ = {};
        options_.shows_environment = true;
        add_shared_options(app, options_);
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
    std::optional<Scene> scene_;
};

TEST_F(TailsChoice, AutomaticOnesKeepNineTenthsOfTheLightWhereverOneLooks) {
    const std::string end = " --camera-position 0,0,180 --camera-focal-point 0,0,200";
    const std::string middle = " --camera-position 0,0,-50 --camera-focal-point 0,-1,0";
    const std::pair<int, float> cases[] = {{128, 1.2f},   {129, 1.2f},    {129, 10.0f},
                                           {129, 60.0f},  {1000, 0.15f},  {1000, 10.0f},
                                           {1000, 60.0f}, {1000, 2000.0f}};
    for (const auto& [count, intensity] : cases) {
        write(hall(count, intensity));
        for (const std::string& camera : {end, middle}) {
            const double exact = light("--tails exact" + camera);
            ASSERT_GT(exact, 0.0);
            EXPECT_NEAR(light(camera) / exact, 1.0, 0.1)
                << count << " of " << intensity << " cd" << camera << " " << open(camera);
        }
    }
}

TEST_F(TailsChoice, TheLineNamesWhatTheSumLoses) {
    write(hall(129, 2000.0f));
    EXPECT_TRUE(contains(open(""),
                         "tails   bounded (automatic): 129 lights without a range end where each "
                         "adds 0.00391 of radiance; their sum loses up to about "))
        << open("");
    EXPECT_TRUE(contains(open("--tails bounded --range-budget 1"),
                         "adds 1 of radiance; their sum loses up to about 100 % at a point "
                         "(--aov error-bound), with --tails exact nothing"))
        << open("--tails bounded --range-budget 1");
}

// A tree lights no blended surfaces.
TEST_F(TailsChoice, BlendedSurfacesKeepBoundedOnesWithAWarning) {
    Scene scene = hall(200, 1.0f);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    write(scene);
    testing::internal::CaptureStderr();
    open("");
    const std::string warning = testing::internal::GetCapturedStderr();
    EXPECT_EQ(options_.settings.tails, Tails::automatic);
    EXPECT_TRUE(contains(warning, "cut up to about")) << warning;
}

// What a tree cannot light keeps bounded ranges.
class KeptRanges : public TailsChoice,
                   public testing::WithParamInterface<std::tuple<int, const char*>> {};

TEST_P(KeptRanges, AreSaidOnceAlsoWithQuiet) {
    const auto& [count, option] = GetParam();
    write(hall(count, 1.0f));
    testing::internal::CaptureStderr();
    const std::string line = open(option);
    open(option);
    const std::string written = testing::internal::GetCapturedStderr();
    EXPECT_EQ(options_.settings.tails, Tails::automatic);
    EXPECT_TRUE(contains(line, "tails   bounded (automatic)")) << line;
    const std::string warning = "kilolux: warning: " + options_.scene +
                                ": the ranges that lights without one get cut up to about ";
    EXPECT_TRUE(written.starts_with(warning)) << written;
    EXPECT_EQ(std::ranges::count(written, '\n'), 1) << written;
}

INSTANTIATE_TEST_SUITE_P(All, KeptRanges,
                         testing::Combine(testing::Values(129, 1000),
                                          testing::Values("--shadows exact",
                                                          "--renderer forward-plus")));

}  // namespace
}  // namespace kilolux
