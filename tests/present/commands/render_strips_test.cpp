// SPDX-License-Identifier: Apache-2.0
// Pictures that do not fit into the memory as a whole are made and written strip by strip.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>

#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// A wide picture of a small scene. With this much memory it has about four strips.
std::vector<std::string> words_of(const fs::path& output, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"/usr/bin/env", "POCL_DEVICES=pthread pthread",
                                      program_file(), "render",
                                      "grid",         "--resolution",
                                      "4096,260",     "--lights",
                                      "20",           "--geometry",
                                      "compute",      "-o",
                                      output.string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

class RenderStrips : public testing::Test {
 protected:
    // Renders a picture whole and with `memory`, and compares the files.
    void expect_same(const std::string& name, std::vector<std::string> options,
                     const std::string& memory, const std::string& device = "0") {
        SCOPED_TRACE(name);
        ASSERT_EQ(run_child(words_of(whole_ / name, options)).code, 0);
        options.insert(options.end(), {"--device", device, "--max-memory", memory});
        const ChildResult result = run_child(words_of(strips_ / name, options));
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_TRUE(text_of_file(strips_ / name) == text_of_file(whole_ / name));
    }

    TemporaryFolder whole_, strips_;
};

constexpr const char* kLittle = "285M";

TEST_F(RenderStrips, AreWhereAWholePictureDoesNotFit) {
    const ChildResult result =
        run_child(words_of(strips_ / "a.hdr", {"--max-memory", kLittle}));  // a format without
    EXPECT_EQ(result.code, 1);
    EXPECT_TRUE(contains(result.err, "memory: 4096x260 pixels with 20 generated lights need"))
        << result.err;
    EXPECT_TRUE(names_in(strips_).empty());
}

TEST_F(RenderStrips, MakeTheFileOfTheWholePicture) {
    expect_same("a.png", {}, kLittle);
    expect_same("b.png", {"--background", "none", "--exposure", "auto"}, kLittle);
    expect_same("c.exr", {"--aov", "depth,light-count,cluster", "--samples", "2"}, "330M");
    expect_same("d.tif", {"--bits", "16"}, kLittle);
}

TEST_F(RenderStrips, MakeFramesOfASequence) {
    const std::vector<std::string> frames = {"--frames", "0:1"};
    std::vector<std::string> strips = frames;
    strips.insert(strips.end(),
                  {"--max-memory", kLittle, "--stats", (strips_ / "s.json").string()});
    ASSERT_EQ(run_child(words_of(whole_ / "f.#.png", frames)).code, 0);
    ASSERT_EQ(run_child(words_of(strips_ / "f.#.png", strips)).code, 0);
    for (const char* name : {"f.0.png", "f.1.png"}) {
        EXPECT_TRUE(text_of_file(strips_ / name) == text_of_file(whole_ / name));
    }
    EXPECT_TRUE(contains(text_of_file(strips_ / "s.json"), "f.1.png"));
}

TEST_F(RenderStrips, OfSeveralDevicesAreWrittenInOrder) {
    expect_same("a.exr", {}, "570M", "all");
    expect_same("b.png", {"--background", "none"}, "570M", "all");
}

TEST_F(RenderStrips, LeaveNothingWhenInterrupted) {
    const std::vector<std::string> words =
        words_of(strips_ / "a.png", {"--max-memory", kLittle, "--samples", "4096"});
    const ChildResult result = run_child(words, [this](pid_t child) {
        // Once the file is begun.
        for (int i = 0; i < 600 && names_in(strips_).empty(); ++i) usleep(100'000);
        EXPECT_FALSE(names_in(strips_).empty());
        kill(child, SIGTERM);
    });
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_TRUE(names_in(strips_).empty());
}

TEST_F(RenderStrips, SayThatTheDiskIsFull) {
    fs::create_symlink("/dev/full", strips_ / "a.png");
    const ChildResult result =
        run_child(words_of(strips_ / "a.png", {"--max-memory", kLittle, "--quiet"}));
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err, "kilolux: " + (strips_ / "a.png").string() +
                              ": cannot write: No space left on device\n");
}

}  // namespace
}  // namespace kilolux
