// SPDX-License-Identifier: Apache-2.0
// `kilolux render` and `info` as a whole: files, sequences, statistics, comparison.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/present/commands/small_render.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// What the display shows, whatever the curve and the exposure.
TEST(Render, ABackgroundHasTheColourThatIsGiven) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.png";
    for (const char* curve : {"none", "neutral", "aces"}) {
        const ChildResult result = run_kilolux(small_render(
            file,
            {"--camera-position", "0,100,0", "--camera-focal-point", "0,200,0", "--camera-view-up",
             "0,0,1", "--background", "#334455", "--tonemap", curve, "--exposure", "1", "-q"}));
        ASSERT_EQ(result.code, 0) << result.err;
        const FloatImage image = read_image(file);
        for (std::size_t i = 0; i < image.values.size(); ++i) {
            const int code = static_cast<int>(std::lround(image.values[i] * 255.0f));
            ASSERT_EQ(code, 0x33 + 0x11 * static_cast<int>(i % 3)) << curve << " " << i;
        }
    }
}

// A crop has the numbers of the whole picture, which has more clusters than a float counts.
TEST(Render, SaysWhichLayerIsUintThoughNobodyAskedForIt) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    const auto says_so = [&](const char* slices, const char* ids) {
        const ChildResult result = run_kilolux(small_render(
            file, {"--resolution", "3072,3072", "--crop", "1536,1536,16,16", "--grid",
                   std::string("192,192,") + slices, "--aov", "cluster", "--aov-ids", ids}));
        EXPECT_EQ(result.code, 0) << result.err;
        return contains(result.err,
                        "a.exr: layer cluster is UINT: a float does not hold its largest");
    };
    EXPECT_TRUE(says_so("64", "float"));
    EXPECT_EQ(read_image(file).ids.size(), 1u);
    EXPECT_FALSE(says_so("64", "uint"));
    EXPECT_FALSE(says_so("4", "float"));
    EXPECT_EQ(read_image(file).ids.size(), 0u);
}

TEST(Render, WritesAnExrThatSaysHowItWasMade) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    const ChildResult result =
        run_kilolux(small_render(file, {"--aov", "depth,position,normal,light-count", "--aov-ids",
                                        "uint", "--stats", "-", "--light-seed", "9"}));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "lights ")) << result.err;
    const FloatImage image = read_image(file);
    EXPECT_EQ(image.width, 48);
    EXPECT_EQ(image.height, 32);
    for (const char* channel : {"R", "G", "B", "Z", "P.X", "N.Z"}) {
        const auto& names = image.channels;
        EXPECT_NE(std::find(names.begin(), names.end(), channel), names.end()) << channel;
    }
    ASSERT_EQ(image.ids.size(), 1u);
    EXPECT_EQ(image.ids[0].name, "light-count");
    EXPECT_GT(*std::max_element(image.ids[0].ids.begin(), image.ids[0].ids.end()), 0u);
    const Json stats = Json::parse(result.out);
    EXPECT_FALSE(stats.at("device").at("name").get<std::string>().empty());
    EXPECT_EQ(stats.at("lights").at("dropped"), 0);
    EXPECT_GE(stats.at("lights").at("given"), 20);
    EXPECT_TRUE(stats.at("evaluations").at("useful_per_pixel").is_number());
    for (const Json& stage : stats.at("stages")) {
        // Stages of the host or OpenGL, and sums of a few numbers, have no model.
        const std::set<std::string> unmodelled = {"light_input", "geometry", "count_pairs",
                                                  "launch",      "enqueue",  "read_back",
                                                  "allocate",    "other"};
        const bool modelled = !unmodelled.contains(stage.at("name"));
        EXPECT_EQ(stage.at("limit_ms").is_number(), modelled) << stage;
    }
    EXPECT_FALSE(stats.at("stages").empty());
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"a.exr"}));
}

TEST(Render, SaysThatLinearLightIsNotExposed) {
    const TemporaryFolder folder;
    for (const char* exposure : {"0", "1", "auto"}) {
        for (const char* name : {"a.exr", "a.png"}) {
            const ChildResult result =
                run_kilolux(small_render(folder / name, {"--exposure", exposure}));
            ASSERT_EQ(result.code, 0) << result.err;
            const bool said =
                contains(result.err, "a.exr: holds linear light, which --exposure does not change");
            EXPECT_EQ(said, name == std::string("a.exr") && exposure != std::string("0"))
                << exposure << " " << result.err;
        }
    }
    const ChildResult more = run_kilolux(
        small_render(folder / "a.exr", {"--exposure", "1", "--tonemap", "aces", "--bloom", "0.5"}));
    EXPECT_TRUE(contains(more.err,
                         "a.exr: holds linear light, which --exposure and --tonemap and --bloom do "
                         "not change"))
        << more.err;
}

TEST(Render, AutomaticSamplesAreTold) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    const std::vector<std::string> options = {
        "--samples", "auto", "--max-samples", "16", "--aov", "sample-count,error-standard",
        "--aov-ids", "uint", "--stats",       "-"};
    const ChildResult result = run_kilolux(small_render(file, options));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "\nsamples ")) << result.err;
    EXPECT_TRUE(contains(result.err, " a pixel, from ")) << result.err;
    const Json samples = Json::parse(result.out).at("samples");
    const FloatImage image = read_image(file);
    ASSERT_EQ(image.ids.size(), 1u);
    EXPECT_EQ(image.ids[0].name, "sample-count");
    const auto& counts = image.ids[0].ids;
    EXPECT_EQ(samples.at("of_all_pixels"), std::accumulate(counts.begin(), counts.end(), 0u));
    EXPECT_EQ(samples.at("least"), std::ranges::min(counts));
    EXPECT_EQ(samples.at("most"), std::ranges::max(counts));
    EXPECT_EQ(samples.at("tiles"), 6);
    EXPECT_LE(samples.at("tiles_above_error"), 6);
    EXPECT_NE(std::ranges::find(image.channels, "error.standard"), image.channels.end());
    const ChildResult fixed = run_kilolux(small_render(file, {"--aov", "sample-count"}));
    EXPECT_EQ(fixed.code, 2);
    EXPECT_TRUE(contains(fixed.err, "aov sample-count: needs --samples auto")) << fixed.err;
}

TEST(Render, TheSameCommandGivesTheSameBytesQuietly) {
    const TemporaryFolder folder;
    for (const char* name : {"a.exr", "b.exr"}) {
        const ChildResult result = run_kilolux(small_render(folder / name, {"--quiet"}));
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        EXPECT_EQ(result.out, "");
    }
    EXPECT_EQ(text_of_file(folder / "a.exr"), text_of_file(folder / "b.exr"));
}

TEST(Render, ComparesWithAReference) {
    const TemporaryFolder folder;
    const std::string reference = (folder / "r.exr").string();
    ASSERT_EQ(run_kilolux(small_render(reference, {"-q"})).code, 0);
    const ChildResult same = run_kilolux(
        small_render(folder / "a.exr", {"--renderer", "deferred-all", "--reference", reference,
                                        "--stats", (folder / "s.json").string()}));
    EXPECT_EQ(same.code, 0) << same.err;
    const Json error = Json::parse(text_of_file(folder / "s.json")).at("error");
    EXPECT_EQ(error.at("value"), 0.0);
    EXPECT_EQ(error.at("passed"), true);
    const std::vector<std::string> darker = {"--ambient",   "0.5",         "--quiet",
                                             "--reference", reference,     "--metric",
                                             "max",         "--threshold", "0.001"};
    const ChildResult other = run_kilolux(small_render(folder / "b.exr", darker));
    EXPECT_EQ(other.code, 3) << other.err;
    EXPECT_TRUE(contains(other.err, "b.exr: max ")) << other.err;
    EXPECT_TRUE(contains(other.err, "(threshold 0.001)")) << other.err;
    EXPECT_TRUE(fs::exists(folder / "b.exr")) << "the picture that failed is there to be looked at";
    // A reference of another size is refused before anything is loaded or rendered.
    const ChildResult other_size =
        run_kilolux({"render", (folder / "s.json").string() + ".glb", "--resolution", "9x9", "-o",
                     (folder / "c.exr").string(), "--reference", reference});
    EXPECT_EQ(other_size.code, 1);
    EXPECT_TRUE(contains(other_size.err, "the reference is 48x32 pixels, the picture 9x9"))
        << other_size.err;
}

TEST(Render, WritesTheDifference) {
    const TemporaryFolder folder;
    const std::string reference = (folder / "r.exr").string();
    ASSERT_EQ(run_kilolux(small_render(reference, {"-q"})).code, 0);
    for (const char* name : {"d.exr", "d.png"}) {
        const std::string difference = (folder / name).string();
        const ChildResult result = run_kilolux(
            small_render(folder / "a.exr", {"-q", "--ambient", "0.5", "--reference", reference,
                                            "--threshold", "9", "--difference", difference}));
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(read_image(difference).width, 48);
    }
    const FloatImage before = read_image(reference);
    const FloatImage after = read_image(folder / "a.exr");
    const FloatImage difference = read_image(folder / "d.exr");
    for (std::size_t i = 0; i < before.values.size(); ++i) {
        ASSERT_EQ(difference.values[i], std::abs(after.values[i] - before.values[i])) << i;
    }
}

TEST(Render, SaysFirstWhatItRenders) {
    const TemporaryFolder folder;
    const std::vector<std::string> words = small_render(folder / "a.png", {"--samples", "2"});
    ASSERT_EQ(run_kilolux(words).code, 0) << "builds the kernels, of which a line tells";
    const ChildResult result = run_kilolux(words);
    const std::size_t device = result.err.find("device  "), rig = result.err.find("\nrig  ");
    const std::size_t picture =
        result.err.find("\npicture 48x32, deferred, grid 16x9x4, 2 samples\n");
    EXPECT_EQ(device, 0u) << result.err;
    EXPECT_LT(picture, rig) << result.err;
    EXPECT_LT(rig, result.err.find("\nlights  20 of 20 used")) << result.err;
}

TEST(Render, AMissingEnvironmentIsFoundBeforeTheSceneIsLoaded) {
    for (const char* command : {"render", "bench", "report"}) {
        const ChildResult result = run_kilolux({command, "no_such_scene.gltf", "--environment",
                                                "no_file.hdr", "-o", "/no_such_folder/a.png"});
        EXPECT_EQ(result.code, 1);
        EXPECT_EQ(result.err, "kilolux: no_file.hdr: no such environment file\n") << command;
    }
}

TEST(Render, ShowsTheErrorAgainstAReference) {
    const TemporaryFolder folder;
    const auto render = [&](const char* file, std::vector<std::string> more) {
        return run_kilolux(small_render(folder / file, std::move(more)));
    };
    const std::string reference = (folder / "r.exr").string();
    ASSERT_EQ(render("r.exr", {}).code, 0);
    const auto shown = [&](const char* file, std::vector<std::string> more) {
        more.insert(more.end(), {"--show", "error", "--reference", reference});
        const ChildResult result = render(file, std::move(more));
        EXPECT_EQ(result.code, 0) << result.err;
        return read_image(folder / file).values;
    };
    const auto equal = shown("equal.png", {"--threshold", "0"});
    EXPECT_LT(std::ranges::max(equal), 0.02f) << "no error has the map's darkest colour";
    // Relative errors of 1 and more have the brightest colour of the heat map.
    const auto far = shown("far.png", {"--ambient", "1000", "--threshold", "1e9"});
    EXPECT_GT(std::ranges::count_if(far, [](float v) { return v > 0.6f; }), 500);
    const auto deep =
        shown("deep.png", {"--ambient", "1000", "--threshold", "1e9", "--bits", "16"});
    for (std::size_t i = 0; i < far.size(); ++i) ASSERT_NEAR(deep[i], far[i], 1e-4f) << i;
}

TEST(Render, ShowErrorNeedsAReferenceAndAPictureForTheEye) {
    const TemporaryFolder folder;
    const ChildResult alone = run_kilolux(small_render(folder / "a.png", {"--show", "error"}));
    EXPECT_EQ(alone.code, 2);
    EXPECT_EQ(alone.err, "kilolux: --show error: needs --reference FILE, which render takes\n");
    const ChildResult light =
        run_kilolux(small_render(folder / "a.exr", {"--show", "error", "--reference", "none.exr"}));
    EXPECT_EQ(light.code, 2);
    EXPECT_TRUE(contains(light.err, "holds light")) << light.err;
    EXPECT_EQ(run_kilolux({"info", "grid", "--show", "error"}).code, 2);
    EXPECT_TRUE(names_in(folder).empty());
}

TEST(Info, TellsDevicePlanAndScene) {
    const ChildResult result = run_kilolux({"info", "grid", "--json"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Json info = Json::parse(result.out);
    EXPECT_GT(info.at("scene").at("triangles"), 0);
    EXPECT_FALSE(info.at("plan").empty());
    EXPECT_GT(info.at("gbuffer_bytes_per_pixel"), 0);
    EXPECT_FALSE(info.at("devices").empty());
    EXPECT_FALSE(info.at("device").at("name").get<std::string>().empty());
    const ChildResult text = run_kilolux({"info", "grid"});
    EXPECT_TRUE(contains(text.out, "triangles: ")) << text.out;
    const ChildResult devices = run_kilolux({"--list-devices"});
    EXPECT_EQ(devices.code, 0);
    EXPECT_TRUE(devices.out.starts_with("0  ")) << devices.out;
}

}  // namespace
}  // namespace kilolux
