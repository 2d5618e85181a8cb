// SPDX-License-Identifier: Apache-2.0
// Pictures that do not fit into the memory as a whole are made and written strip by strip.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/stat.h>
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
    // Renders a picture whole and with `memory`, which the whole does not fit into, and compares
    // the files. Returns what the program said.
    std::string expect_same(const std::string& name, std::vector<std::string> options,
                            const std::string& memory, const std::string& device = "0") {
        SCOPED_TRACE(name);
        EXPECT_EQ(run_child(words_of(whole_ / name, options)).code, 0);
        options.insert(options.end(), {"--device", device, "--max-memory", memory});
        const ChildResult result = run_child(words_of(strips_ / name, options));
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_TRUE(text_of_file(strips_ / name) == text_of_file(whole_ / name));
        options.insert(options.end(), {"--bloom", "0.1"});  // which needs the whole
        const ChildResult refused = run_child(words_of(strips_ / ("whole." + name), options));
        EXPECT_EQ(refused.code, 1);
        EXPECT_TRUE(contains(refused.err, "pixels with 20 lights need")) << refused.err;
        return result.err;
    }

    TemporaryFolder whole_, strips_;
};

constexpr const char* kLittleForTwo = "620M";
constexpr const char* kLittle = "288M";

TEST_F(RenderStrips, AreWhereAWholePictureDoesNotFit) {
    const ChildResult result =
        run_child(words_of(strips_ / "a.hdr", {"--max-memory", kLittle}));  // a format without
    EXPECT_EQ(result.code, 1);
    EXPECT_TRUE(contains(result.err, "memory: 4096x260 pixels with 20 lights need")) << result.err;
    EXPECT_TRUE(names_in(strips_).empty());
}

TEST_F(RenderStrips, MakeTheFileOfTheWholePicture) {
    expect_same("a.png", {}, kLittle);
    expect_same("b.png", {"--background", "none", "--exposure", "auto"}, kLittle);
    expect_same("c.exr", {"--aov", "depth,light-count,cluster", "--samples", "2"}, "345M");
    expect_same("d.tif", {"--bits", "16"}, kLittle);
}

TEST_F(RenderStrips, MakeFramesOfASequence) {
    // With alpha each strip is made before two backgrounds.
    const std::vector<std::string> frames = {"--frames", "0:1", "--background", "none"};
    std::vector<std::string> strips = frames;
    strips.insert(strips.end(),
                  {"--max-memory", kLittle, "--stats", (strips_ / "s.json").string()});
    for (const char* name : {"f.#.png", "f.#.exr"}) {
        ASSERT_EQ(run_child(words_of(whole_ / name, frames)).code, 0);
        ASSERT_EQ(run_child(words_of(strips_ / name, strips)).code, 0);
    }
    for (const char* name : {"f.0.png", "f.1.png", "f.0.exr", "f.1.exr"}) {
        EXPECT_TRUE(text_of_file(strips_ / name) == text_of_file(whole_ / name)) << name;
    }
    const std::string stats = text_of_file(strips_ / "s.json");
    EXPECT_TRUE(contains(stats, "f.0.exr") && contains(stats, "f.1.exr")) << stats;
    // Files that are there are known by what they note.
    strips.push_back("--skip-existing");
    const ChildResult again = run_child(words_of(strips_ / "f.#.exr", strips));
    EXPECT_TRUE(contains(again.err, "nothing to render")) << again.err;
}

TEST_F(RenderStrips, OfSeveralDevicesAreWrittenInOrder) {
    for (const std::string& said :
         {expect_same("a.exr", {"--samples", "8"}, kLittleForTwo, "all"),
          expect_same("b.png", {"--background", "none"}, kLittleForTwo, "all")}) {
        EXPECT_TRUE(contains(said, "\ndevice 1 (")) << said;
        EXPECT_FALSE(contains(said, ": 260 rows in ")) << "one made all\n" << said;
    }
}

// The whole picture takes 1.1 GB. Kernels that are not built yet take their compiler.
TEST_F(RenderStrips, StayWithinTheMemory) {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "the sanitizer takes memory of its own";
#endif
    constexpr long kLimit = 350, kCompiler = 150;  // [MiB]
    std::vector<std::string> words =
        words_of(strips_ / "a.exr", {"--device", "0", "--max-memory", fmt::format("{}M", kLimit)});
    std::ranges::replace(words, std::string("4096,260"), std::string("4096,3072"));
    const ChildResult result = run_child(words);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_LE(result.peak_kib, (kLimit + kCompiler) * 1024);
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
    EXPECT_EQ(result.code, 143) << result.err;
    EXPECT_TRUE(names_in(strips_).empty());
}

// The system's reason, and no part of a file.
TEST_F(RenderStrips, SayThatTheDiskIsFull) {
    if (mount("kilolux", strips_.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
        GTEST_SKIP() << "no permission to mount a tmpfs";
    }
    for (const char* name : {"a.png", "a.exr", "a.tif"}) {
        const ChildResult result =
            run_child(words_of(strips_ / name, {"--max-memory", kLittle, "--quiet"}));
        EXPECT_EQ(result.code, 1);
        EXPECT_EQ(result.err, "kilolux: " + (strips_ / name).string() +
                                  ": cannot write: No space left on device\n");
        EXPECT_TRUE(names_in(strips_).empty());
    }
    EXPECT_EQ(umount(strips_.path().c_str()), 0);
}

// A pipe cannot seek, and gets the whole picture.
TEST_F(RenderStrips, AreNotSentThroughPipes) {
    const fs::path pipe = strips_ / "a.exr";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const ChildResult result = run_child(words_of(pipe, {"--max-memory", kLittle}));
    EXPECT_EQ(result.code, 1);
    EXPECT_TRUE(contains(result.err, "memory: ")) << result.err;
}

}  // namespace
}  // namespace kilolux
