// SPDX-License-Identifier: Apache-2.0
// Cameras of sequences: files of keys and their mistakes, turntables, shards.
#include <gtest/gtest.h>

#include "host/base/error.h"
#include "present/commands/camera_motion.h"
#include "present/image/read.h"
#include "tests/support/box_scene.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

std::string keys_error(const std::string& text) {
    const TemporaryFolder folder;
    write_text(folder / "keys.json", text);
    const std::string message =
        message_of<Error>([&] { read_camera_keys(folder / "keys.json", 45.0); });
    const std::string prefix = (folder / "keys.json").string() + ": ";
    EXPECT_TRUE(message.starts_with(prefix)) << message;
    return message.substr(std::min(message.size(), prefix.size()));
}

TEST(CameraKeys, AreReadWithTheirAngles) {
    const TemporaryFolder folder;
    write_text(folder / "keys.json",
               R"([{"time": -1, "position": [0, 1, 2.5], "focal_point": [0, 0, 0]},
                   {"time": 2, "position": [3, 1, 0], "focal_point": [0, 1, 0], "angle": 60}])");
    const std::vector<CameraKey> keys = read_camera_keys(folder / "keys.json", 33.0);
    ASSERT_EQ(keys.size(), 2u);
    EXPECT_EQ(keys[0].time, -1.0);
    EXPECT_EQ(keys[0].position, glm::dvec3(0, 1, 2.5));
    EXPECT_EQ(keys[0].angle, 33.0);
    EXPECT_EQ(keys[1].focal_point, glm::dvec3(0, 1, 0));
    EXPECT_EQ(keys[1].angle, 60.0);
}

TEST(CameraKeys, MistakesAreOneLineThatNamesTheKey) {
    EXPECT_EQ(message_of<Error>([] { read_camera_keys("no/such.json", 45.0); }),
              "no/such.json: cannot read: No such file or directory");
    EXPECT_EQ(keys_error("[{\"time\": 0,"), "no JSON, at byte 13");
    EXPECT_EQ(keys_error("{}"), "must be a list of at least one key");
    EXPECT_EQ(keys_error("[]"), "must be a list of at least one key");
    EXPECT_EQ(keys_error("[3]"), "key 0 is no object");
    const std::string good = R"({"time": 1, "position": [1, 2, 3], "focal_point": [0, 0, 0]})";
    EXPECT_EQ(keys_error("[" + good + R"(, {"time": 2, "focal_point": [0, 0, 0]}])"),
              "key 1 has no position");
    EXPECT_EQ(keys_error(R"([{"time": "now", "position": [1,2,3], "focal_point": [0,0,0]}])"),
              "key 0: time is \"now\", must be a number");
    EXPECT_EQ(keys_error(R"([{"time": 0, "position": [1,2], "focal_point": [0,0,0]}])"),
              "key 0: position is [1,2], must be [x, y, z]");
    EXPECT_EQ(keys_error(R"([{"time": 0, "position": [1,2,3], "focal_point": [1,2,3]}])"),
              "key 0: position and focal_point are the same point");
    EXPECT_EQ(
        keys_error(R"([{"time": 0, "position": [1,2,3], "focal_point": [0,0,0], "angle": 180}])"),
        "key 0: angle is 180, must be above 0 and below 180");
    EXPECT_EQ(
        keys_error(R"([{"time": 0, "position": [1,2,3], "focal_point": [0,0,0], "fov": 18}])"),
        "key 0: fov: keys have time, position, focal_point and angle");
    EXPECT_EQ(keys_error("[" + good + "," + good + "]"),
              "key 1: time is 1, must be above 1, that of the key before");
}

TEST(CameraMotion, ATurntableGoesOnceAroundItsFrames) {
    const Scene scene = box_scene(glm::dvec3(2.0, 1.0, 1.0));
    SharedOptions shared;
    OutputOptions output;
    output.frames = FrameRange{10, 13};
    const Camera still = CameraMotion(shared, output).at(scene, 10, 0.0);
    output.turntable = 360.0;
    const CameraMotion motion(shared, output);
    EXPECT_EQ(motion.at(scene, 10, 0.0), still);
    const glm::dvec3 quarter = motion.at(scene, 11, 5.0).position;
    EXPECT_NEAR(quarter.x, still.position.z, 1e-12);
    EXPECT_NEAR(quarter.z, -still.position.x, 1e-12);
    const glm::dvec3 last = motion.at(scene, 13, 5.0).position;
    EXPECT_NEAR(last.x, -still.position.z, 1e-12) << "the next one would be the first again";
}

// Every shard's pictures are the whole sequence's, and a frame is what its camera alone gives.
TEST(CameraMotion, ShardsAndSinglePicturesAgree) {
    const TemporaryFolder folder;
    write_text(folder / "keys.json",
               R"([{"time": 0, "position": [0, 2, 8], "focal_point": [0, 0, 0], "angle": 50},
                   {"time": 1, "position": [8, 3, 0], "focal_point": [0, 1, 0], "angle": 40}])");
    const auto render = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"render", "grid",          "-q", "--lights",
                                          "20",     "--fps",         "2",  "--resolution",
                                          "48x32",  "--environment", "sky"};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
    };
    const std::string keys = (folder / "keys.json").string();
    render({"--frames", "0:2", "--camera-keys", keys, "-o", (folder / "a#.exr").string()});
    render({"--frames", "0:2", "--camera-keys", keys, "--shard", "1/2", "-o",
            (folder / "b#.exr").string()});
    render({"--time", "1", "--camera-position", "8,3,0", "--camera-focal-point", "0,1,0",
            "--camera-view-angle", "40", "-o", (folder / "c2.exr").string()});
    const auto pixels = [&](const char* name) { return read_image(folder / name).values; };
    EXPECT_EQ(pixels("a1.exr"), pixels("b1.exr"));
    EXPECT_EQ(pixels("a2.exr"), pixels("c2.exr"));
    EXPECT_NE(pixels("a1.exr"), pixels("a2.exr"));
    render({"--frames", "0:3", "--turntable", "180", "-o", (folder / "d#.exr").string()});
    render({"--frames", "0:3", "--turntable", "180", "--shard", "3/4", "-o",
            (folder / "e#.exr").string()});
    EXPECT_EQ(pixels("d3.exr"), pixels("e3.exr"));
    EXPECT_NE(pixels("d3.exr"), pixels("d0.exr"));
}

TEST(CameraMotion, WhatExcludesEachOtherIsSaid) {
    const auto refused = [](std::vector<std::string> more) {
        std::vector<std::string> words = {"render", "grid", "-o", "x.png"};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 2) << result.err;
        return result.err;
    };
    EXPECT_TRUE(contains(refused({"--turntable", "90"}), "--turntable: needs --frames A:B"));
    EXPECT_TRUE(contains(refused({"--camera-keys", "k.json", "--camera-index", "0"}),
                         "--camera-keys: says where the camera is"));
    EXPECT_TRUE(contains(run_kilolux({"render", "grid", "-o", "x#.png", "--frames", "0:1",
                                      "--camera-keys", "k.json", "--turntable", "9"})
                             .err,
                         "exclude each other"));
}

}  // namespace
}  // namespace kilolux
