// SPDX-License-Identifier: Apache-2.0
// Files with lights as Blender writes them: without a range, in child nodes that turn them.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "host/certify/tail_scenarios.h"
#include "host/scene/gltf/load_scene.h"
#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

using Json = nlohmann::json;

std::string blender_file() { return source_root() + "/tests/present/scenes/blender_lights.gltf"; }

FloatImage picture_of(const std::string& scene, const std::vector<std::string>& more) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.exr").string();
    std::vector<std::string> words = {"render", scene, "-q", "--resolution", "96,54", "-o", file};
    words.insert(words.end(), more.begin(), more.end());
    const ChildResult result = run_kilolux(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return read_image(file);
}

// The picture in each shading against float64 lights without a range.
void expect_unlimited_lights(const std::string& file) {
    const Scene scene = load_scene(file);
    Scene endless = scene;  // its lights lose their ranges
    for (SceneLight& light : endless.lights) light.range = 1e18f;
    for (const Shading shading : {Shading::lambert, Shading::blinn_phong, Shading::pbr}) {
        RenderSettings settings = small_settings(96, 54, 0);
        settings.shading = shading;
        settings.gbuffer = GBUFFER_FULL;
        const TailAgreement found = compare_tails({"", scene, first_camera(scene)}, settings);
        EXPECT_GT(found.values, 5000) << static_cast<int>(shading);
        EXPECT_LE(found.largest_error, 1e-5) << static_cast<int>(shading);
        EXPECT_EQ(render_once(scene, settings).radiance, render_once(endless, settings).radiance);
    }
}

// The grid with `count` generated lights, exported; their ranges are taken away.
std::string export_without_ranges(const TemporaryFolder& folder, int count) {
    const std::string file = (folder / "s.gltf").string();
    const ChildResult result =
        run_kilolux({"export", "grid", "-q", "--lights", std::to_string(count), "-o", file});
    EXPECT_EQ(result.code, 0) << result.err;
    Json root = Json::parse(text_of_file(file));
    std::size_t removed = 0;
    for (Json& light : root.at("extensions").at("KHR_lights_punctual").at("lights")) {
        removed += light.erase("range");
    }
    EXPECT_EQ(removed, static_cast<std::size_t>(count));
    write_text(file, root.dump());
    return file;
}

TEST(BlenderLights, OfAnExportedSceneAreExactWhereTheyAreFew) {
    const TemporaryFolder folder;
    const std::string file = export_without_ranges(folder, 100);
    expect_unlimited_lights(file);
    const FloatImage exact = picture_of(file, {"--tails", "exact"});
    EXPECT_EQ(picture_of(file, {}).values, exact.values);
    EXPECT_NE(picture_of(file, {"--tails", "bounded"}).values, exact.values);
}

// Bounded ranges would lose a fifth.
TEST(BlenderLights, OfAnExportedSceneAreInATreeWhereTheyAreMany) {
    const TemporaryFolder folder;
    const std::string file = export_without_ranges(folder, static_cast<int>(kExactTails) + 1);
    const FloatImage automatic = picture_of(file, {});
    EXPECT_EQ(automatic.values, picture_of(file, {"--tails", "tree"}).values);
    EXPECT_NE(automatic.values, picture_of(file, {"--tails", "bounded"}).values);
    const ChildResult info = run_kilolux({"info", file, "--resolution", "96,54"});
    EXPECT_TRUE(contains(info.err, "tails   tree (automatic): 129 lights without a range reach"))
        << info.err << "as render has it";
}

TEST(BlenderLights, OfAFileAreWhereItsNodesTurnThem) {
    const Scene scene = load_scene(blender_file());
    ASSERT_EQ(scene.lights.size(), 5u);
    const auto aim = [&](LightType type) {
        const auto light = std::ranges::find(scene.lights, type, &SceneLight::type);
        return light == scene.lights.end() ? glm::dvec3(0.0) : glm::dvec3(light->direction);
    };
    // From (-3, 7, 2) to (0, 0, -1.5), and from (3.1, 4.2, 2.4) to (1.2, 0, 1.6).
    const glm::dvec3 sun = glm::normalize(glm::dvec3(3.0, -7.0, -3.5));
    const glm::dvec3 spot = glm::normalize(glm::dvec3(-1.9, -4.2, -0.8));
    EXPECT_LT(glm::distance(aim(LightType::directional), sun), 1e-6);
    EXPECT_LT(glm::distance(aim(LightType::spot), spot), 1e-6);
    EXPECT_EQ(std::ranges::count_if(scene.lights, lacks_range), 4);
}

TEST(BlenderLights, OfAFileAreTheUnlimitedOnes) {
    expect_unlimited_lights(blender_file());
    const FloatImage listed = picture_of(blender_file(), {});
    EXPECT_EQ(picture_of(blender_file(), {"--renderer", "deferred-all"}).values, listed.values);
    EXPECT_EQ(picture_of(blender_file(), {"--tails", "exact"}).values, listed.values);
}

TEST(BlenderLights, AreSpokenOf) {
    const TemporaryFolder folder;
    const std::string said =
        "tails   exact (automatic): 4 lights without a range reach every pixel";
    const std::vector<std::string> size = {"--resolution", "96,54"};
    for (std::vector<std::string> words :
         {std::vector<std::string>{"info", blender_file()},
          {"render", blender_file(), "-o", (folder / "a.png").string()}}) {
        words.insert(words.end(), size.begin(), size.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_TRUE(contains(result.err, said)) << result.err;
    }
}

}  // namespace
}  // namespace kilolux
