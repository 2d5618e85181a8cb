// SPDX-License-Identifier: Apache-2.0
// `kilolux render` and `info` as a whole: files, sequences, statistics, comparison, interruption.
#include <gtest/gtest.h>
#include <time.h>

#include <nlohmann/json.hpp>

#include "child.h"
#include "messages.h"
#include "present/image_file.h"

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

TEST(Render, WritesAnExrThatSaysHowItWasMade) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    const ChildResult result = run_kilolux(small_render(
        file, {"--aov", "depth,position,normal,light-count", "--stats", "-", "--light-seed", "9"}));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "lights ")) << result.err;
    const FloatImage image = read_image(file);
    EXPECT_EQ(image.width, 48);
    EXPECT_EQ(image.height, 32);
    for (const char* channel : {"R", "G", "B", "Z", "P.X", "N.Z", "light-count"}) {
        const auto& names = image.channels;
        EXPECT_NE(std::find(names.begin(), names.end(), channel), names.end()) << channel;
    }
    const Json stats = Json::parse(result.out);
    EXPECT_FALSE(stats.at("device").at("name").get<std::string>().empty());
    EXPECT_EQ(stats.at("lights").at("dropped"), 0);
    EXPECT_GE(stats.at("lights").at("given"), 20);
    EXPECT_TRUE(stats.at("evaluations").at("useful_per_pixel").is_number());
    EXPECT_FALSE(stats.at("stages").empty());
    EXPECT_EQ(folder.names(), (std::set<std::string>{"a.exr"}));
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
    EXPECT_EQ(run_kilolux({"render", "grid", "-q", "--resolution", "9,9", "-o",
                           (folder / "c.exr").string(), "--reference", reference})
                  .code,
              1);
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
    EXPECT_EQ(folder.names(), (std::set<std::string>{"f.03.exr", "f.05.exr"}));
    const Json frames = Json::parse(first.out).at("frames");
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames[1].at("frame"), 5);
    EXPECT_EQ(frames[1].at("time"), 2.5);
    ASSERT_EQ(shard("1/2").code, 0);
    EXPECT_EQ(folder.names().size(), 4u);
    // Frame 5 alone at its time is the same picture: time comes from the frame's number.
    const fs::path alone = folder / "alone.exr";
    ASSERT_EQ(run_kilolux(small_render(alone, {"--time", "2.5", "-q"})).code, 0);
    EXPECT_EQ(read_image(alone).values, read_image(folder / "f.05.exr").values);
    EXPECT_NE(read_image(alone).values, read_image(folder / "f.03.exr").values);
    write_text(folder / "f.03.exr", "kept");
    fs::remove(folder / "f.05.exr");
    ASSERT_EQ(shard("0/2").code, 0);
    EXPECT_EQ(text_of_file(folder / "f.03.exr"), "kept");
    EXPECT_TRUE(fs::exists(folder / "f.05.exr"));
    const ChildResult nothing = shard("0/2");
    EXPECT_EQ(nothing.code, 0);
    EXPECT_TRUE(contains(nothing.err, "nothing to render")) << nothing.err;
}

// Waits until the program has written its first frame, for two minutes at most.
void wait_for(const fs::path& file) {
    const timespec pause{0, 5'000'000};
    for (int i = 0; i < 24'000 && !fs::exists(file); ++i) nanosleep(&pause, nullptr);
}

TEST(Render, ASignalEndsASequenceBetweenFrames) {
    for (const int number : {SIGINT, SIGTERM}) {
        const TemporaryFolder folder;
        const auto words = small_render(folder / "f.#.exr", {"--frames", "0:1000000"});
        const ChildResult result = run_kilolux(words, [&](pid_t child) {
            wait_for(folder / "f.0.exr");
            kill(child, number);
        });
        EXPECT_EQ(result.code, 130) << "signal " << result.signal << " " << result.err;
        EXPECT_EQ(result.err, "kilolux: interrupted\n");
        for (const std::string& name : folder.names()) {
            EXPECT_TRUE(name.starts_with("f.")) << name;
            EXPECT_EQ(read_image(folder / name).width, 48) << name;
        }
    }
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
