// SPDX-License-Identifier: Apache-2.0
// `kilolux render` as a whole: sequences, shards, and the notes by which files are kept.
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

}  // namespace
}  // namespace kilolux
