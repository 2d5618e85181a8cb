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
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// A picture small enough for any machine.
std::vector<std::string> small_render(const fs::path& output, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"render",   "grid", "--resolution", "48,32",
                                      "--lights", "20",   "-o",           output.string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

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

TEST(Render, SequencesInShardsThatGoOnWhereTheyStopped) {
    const TemporaryFolder folder;
    const fs::path pattern = folder / "f.##.exr";
    const auto shard = [&](const char* which) {
        return run_kilolux(small_render(pattern, {"--frames", "3:6", "--fps", "2", "--shard", which,
                                                  "--skip-existing", "--stats", "-"}));
    };
    const ChildResult first = shard("0/2");
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"f.03.exr", "f.05.exr"}));
    const Json frames = Json::parse(first.out).at("frames");
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames[1].at("frame"), 5);
    EXPECT_EQ(frames[1].at("time"), 2.5);
    ASSERT_EQ(shard("1/2").code, 0);
    EXPECT_TRUE(contains(shard("1/2").err, "every file is there"));
    EXPECT_TRUE(contains(shard("7/8").err, "shard 7/8 has none of the frames 3:6"));
    EXPECT_EQ(names_in(folder).size(), 4u);
    // A file that holds no picture is made anew, another picture is refused by name.
    write_text(folder / "f.05.exr", "");
    const ChildResult again = shard("0/2");
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_TRUE(contains(again.err, "f.05.exr") && contains(again.err, "made anew")) << again.err;
    EXPECT_EQ(Json::parse(again.out).at("frames").size(), 1u);
    const auto refusal = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"--frames", "3:6", "--fps", "2", "--skip-existing"};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(small_render(pattern, words));
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_TRUE(contains(result.err, "f.03.exr: holds another picture")) << result.err;
        return result.err;
    };
    EXPECT_TRUE(contains(refusal({"--resolution", "32,16"}), "size"));
    EXPECT_TRUE(contains(refusal({"--light-seed", "9"}), "--light-seed 9"));
    EXPECT_TRUE(contains(refusal({"--time", "7"}), "--time 7"));
    EXPECT_TRUE(contains(refusal({"--fps", "3"}), "time is '1.5 s', but '1 s' is asked for"));
    // Frame 5 alone at its time is the same picture: time comes from the frame's number.
    const fs::path alone = folder / "alone.exr";
    ASSERT_EQ(run_kilolux(small_render(alone, {"--time", "2.5", "-q"})).code, 0);
    EXPECT_EQ(read_image(alone).values, read_image(folder / "f.05.exr").values);
    EXPECT_NE(read_image(alone).values, read_image(folder / "f.03.exr").values);
    const auto made = fs::last_write_time(folder / "f.03.exr");
    fs::remove(folder / "f.05.exr");
    ASSERT_EQ(shard("0/2").code, 0);
    EXPECT_EQ(fs::last_write_time(folder / "f.03.exr"), made) << "kept";
    EXPECT_TRUE(fs::exists(folder / "f.05.exr"));
    const ChildResult nothing = shard("0/2");
    EXPECT_EQ(nothing.code, 0);
    EXPECT_TRUE(contains(nothing.err, "nothing to render")) << nothing.err;
}

// --skip-existing keeps a file of any format, and refuses one of another command by its note.
TEST(Render, FilesOfEveryFormatKnowTheirCommand) {
    const TemporaryFolder folder;
    for (const std::string& extension : image_extensions()) {
        const fs::path file = folder / ("picture" + extension);
        const auto made = [&](const std::string& seed) {
            const std::vector<std::string> words = {"--skip-existing",
                                                    "--lights",
                                                    "33",
                                                    "--light-seed",
                                                    seed,
                                                    "--light-intensity",
                                                    "2.25",
                                                    "--grid",
                                                    "8,8,2",
                                                    "--range-budget",
                                                    "0.0123456789",
                                                    "--camera-position",
                                                    "1.25,2.5,3.75"};
            return run_kilolux(small_render(file, words));
        };
        const ChildResult first = made("8");
        ASSERT_EQ(first.code, 0) << first.err;
        const std::string bytes = text_of_file(file);
        const ChildResult again = made("8");
        EXPECT_EQ(again.code, 0) << again.err;
        EXPECT_TRUE(contains(again.err, "nothing to render")) << extension << again.err;
        const ChildResult other = made("9");
        EXPECT_EQ(other.code, 1) << extension;
        EXPECT_TRUE(contains(other.err, file.string() + ": holds another picture: its command is"))
            << other.err;
        EXPECT_EQ(text_of_file(file), bytes);
        EXPECT_EQ(read_image(file).width, 48) << "the notes leave a file that can be read";
        // Cut off in its notes, or in its pixels.
        for (const std::size_t length : {std::size_t{40}, bytes.size() - 20}) {
            write_text(file, bytes.substr(0, length));
            const ChildResult cut = made("8");
            EXPECT_EQ(cut.code, 0) << cut.err;
            EXPECT_TRUE(cut.err.starts_with("kilolux: warning: " + file.string() +
                                            ": cannot read the image: "))
                << cut.err;
            const std::string first_line = cut.err.substr(0, cut.err.find('\n'));
            EXPECT_TRUE(first_line.ends_with("; it is made anew")) << cut.err;
            EXPECT_EQ(cut.err.find("made anew"), cut.err.rfind("made anew")) << cut.err;
            EXPECT_FALSE(contains(cut.err, "libpng")) << cut.err;
            EXPECT_EQ(text_of_file(file), bytes) << extension << " of " << length;
        }
    }
}

TEST(Render, AnAutomaticExposureBelongsToTheFirstFrame) {
    const TemporaryFolder folder;
    const auto made = [&](const char* frames) {
        return run_kilolux(small_render(
            folder / "f.#.png", {"--exposure", "auto", "--skip-existing", "--frames", frames}));
    };
    ASSERT_EQ(made("2:3").code, 0);
    EXPECT_EQ(made("2:4").code, 0) << "exposed by frame 2, too";
    const ChildResult other = made("3:5");
    EXPECT_EQ(other.code, 1);
    EXPECT_TRUE(contains(other.err, "f.3.png: holds another picture")) << other.err;
}

// A glTF file with a light, a camera, and a triangle that moves.
void write_moving_scene(const fs::path& file) {
    const char* text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":40,"range":9}]}},
"nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[0,0,2]},
{"camera":0,"translation":[0,0,4]}],
"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"animations":[{"samplers":[{"input":1,"output":2}],"channels":[
{"sampler":0,"target":{"node":0,"path":"translation"}}]}],
"buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,)"
                       "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"  // three corners
                       "AAAAAAAAgEAAAIA/AACAPwAAgD8AAABAAACAPwAAgD8="      // key times, places
                       R"("}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},
{"buffer":0,"byteOffset":44,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[-1,-1,0],"max":[1,1,0]},{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR",
"min":[0],"max":[4]},{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}]})";
    write_text(file, text);
}

Frame sky_of(float light) {
    Frame frame;
    frame.width = 2;
    frame.height = 1;
    frame.radiance.assign(6, light);
    return frame;
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

// --skip-existing refuses a file by name after an input file of the same name has changed.
TEST(Render, FilesKnowTheContentOfTheirInputs) {
    const auto key_at = [](const std::string& z) {
        return R"([{"time":0,"position":[0,1,4],"focal_point":[0,1,)" + z + "]}]";
    };
    const TemporaryFolder folder;
    write_moving_scene(folder / "m.gltf");
    write_image(folder / "sky.hdr", sky_of(0.5f));
    write_text(folder / "keys.json", key_at("0"));
    for (const char* name : {"a.png", "a.y4m", "a.exr"}) {
        const auto made = [&] {
            return run_kilolux({"render", (folder / "m.gltf").string(), "--resolution", "48,32",
                                "--environment", (folder / "sky.hdr").string(), "--camera-keys",
                                (folder / "keys.json").string(), "--skip-existing", "-o",
                                (folder / name).string()});
        };
        const auto is_refused = [&] {
            const ChildResult result = made();
            EXPECT_TRUE(contains(result.err, std::string(name) + ": holds another")) << result.err;
            return result.code == 1;
        };
        ASSERT_EQ(made().code, 0) << made().err;
        const std::string keys = text_of_file(folder / "keys.json");
        write_text(folder / "keys.json", key_at("-1"));
        EXPECT_TRUE(is_refused()) << name << " keys";
        write_text(folder / "keys.json", keys);
        EXPECT_TRUE(contains(made().err, "nothing to render")) << name;
        write_image(folder / "sky.hdr", sky_of(0.75f));
        EXPECT_TRUE(is_refused()) << name << " environment";
        write_image(folder / "sky.hdr", sky_of(0.5f));
        const std::string scene = text_of_file(folder / "m.gltf");
        write_text(folder / "m.gltf", scene + " ");
        EXPECT_TRUE(is_refused()) << name << " scene";
        write_text(folder / "m.gltf", scene);
        EXPECT_TRUE(contains(made().err, "nothing to render")) << name;
    }
}

TEST(Render, FourShardsAreOneSequenceOfAnAnimatedScene) {
    const TemporaryFolder folder;
    write_moving_scene(folder / "m.gltf");
    // Lit by the scene's own light: generated ones would be placed by the bounds at --time.
    const auto render = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words = {
            "render", (folder / "m.gltf").string(), "-q", "--resolution", "48,32", "--lights", "0",
            "-o",     (folder / name).string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_kilolux(words);
    };
    const std::vector<std::string> frames = {"--frames", "0:5", "--fps", "2"};
    ASSERT_EQ(render("one.#.exr", frames).code, 0) << render("one.#.exr", frames).err;
    std::vector<ChildResult> results(4);
    std::vector<std::jthread> shards;
    for (int i = 0; i < 4; ++i) {
        shards.emplace_back([&, i] {
            results[static_cast<std::size_t>(i)] =
                render("four.#.exr",
                       {"--frames", "0:5", "--fps", "2", "--shard", std::to_string(i) + "/4"});
        });
    }
    shards.clear();
    for (const ChildResult& result : results) EXPECT_EQ(result.code, 0) << result.err;
    for (int frame = 0; frame <= 5; ++frame) {
        const std::string number = std::to_string(frame);
        const std::string one = text_of_file(folder / ("one." + number + ".exr"));
        EXPECT_EQ(one, text_of_file(folder / ("four." + number + ".exr"))) << frame;
        ASSERT_EQ(render("alone.exr", {"--time", std::to_string(frame / 2.0)}).code, 0);
        EXPECT_EQ(read_image(folder / "alone.exr").values,
                  read_image(folder / ("one." + number + ".exr")).values);
        if (frame == 0) continue;
        EXPECT_NE(read_image(folder / "one.0.exr").values,
                  read_image(folder / ("one." + number + ".exr")).values);
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
