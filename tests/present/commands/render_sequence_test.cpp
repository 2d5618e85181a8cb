// SPDX-License-Identifier: Apache-2.0
// Sequences of `kilolux render`, whose pictures are coded and written while the next are made.
#include <gtest/gtest.h>
#include <time.h>
#include <chrono>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// A sequence small enough for any machine.
std::vector<std::string> small_sequence(const fs::path& output, std::vector<std::string> more) {
    std::vector<std::string> words = {"render",   "grid", "--resolution", "48,32",
                                      "--lights", "20",   "-o",           output.string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::string numbered(int frame, const char* extension) {
    return "f." + std::to_string(frame) + extension;
}

// A shard of one picture holds none while others are made.
TEST(RenderSequence, HasTheBytesOfItsPicturesAlone) {
    constexpr int kFrames = 4;
    for (const char* extension : {".png", ".exr"}) {
        const TemporaryFolder together, alone;
        const std::string name = std::string("f.#") + extension;
        const std::vector<std::string> frames = {"--frames", "0:" + std::to_string(kFrames - 1)};
        const ChildResult result = run_kilolux(small_sequence(together / name, frames));
        ASSERT_EQ(result.code, 0) << result.err;
        for (int frame = 0; frame < kFrames; ++frame) {
            const std::string shard = std::to_string(frame) + "/" + std::to_string(kFrames);
            std::vector<std::string> one = frames;
            one.insert(one.end(), {"--shard", shard});
            ASSERT_EQ(run_kilolux(small_sequence(alone / name, one)).code, 0);
            const std::string file = numbered(frame, extension);
            EXPECT_FALSE(text_of_file(alone / file).empty());
            EXPECT_EQ(text_of_file(together / file), text_of_file(alone / file)) << file;
        }
        EXPECT_EQ(names_in(together), names_in(alone));
    }
}

TEST(RenderSequence, WritesTheDifferencesOfPicturesAndVideos) {
    const TemporaryFolder folder;
    const std::vector<std::string> frames = {"--frames", "0:2"};
    ASSERT_EQ(run_kilolux(small_sequence(folder / "r.#.exr", frames)).code, 0);
    for (const char* output : {"f.#.exr", "f.y4m"}) {
        const fs::path difference = folder / (std::string(output) + ".d.#.exr");
        std::vector<std::string> words = frames;
        words.insert(words.end(), {"--reference", (folder / "r.#.exr").string(), "--difference",
                                   difference.string(), "--exposure", "1"});
        const ChildResult result = run_kilolux(small_sequence(folder / output, words));
        ASSERT_EQ(result.code, 0) << result.err;
        for (int frame = 0; frame < 3; ++frame) {
            const std::string name = std::string(output) + ".d." + std::to_string(frame) + ".exr";
            EXPECT_EQ(read_image(folder / name).width, 48) << name;
        }
    }
}

TEST(RenderSequence, APictureThatCannotBeWrittenIsNamedAndIsTheLast) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "f.3.png");
    const ChildResult result = run_kilolux(small_sequence(folder / "f.#.png", {"--frames", "0:8"}));
    EXPECT_EQ(result.code, 1);
    EXPECT_TRUE(contains(result.err, "f.3.png: cannot write: Is a directory")) << result.err;
    EXPECT_EQ(names_in(folder),
              (std::set<std::string>{"f.0.png", "f.1.png", "f.2.png", "f.3.png"}));
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_GT(fs::file_size(folder / numbered(frame, ".png")), 500u);
    }
}

// Waits until the program has written its first frame, for two minutes at most.
void wait_for(const fs::path& file) {
    const timespec pause{0, 5'000'000};
    for (int i = 0; i < 24'000 && !fs::exists(file); ++i) nanosleep(&pause, nullptr);
}

// The list of its frames would take 8 GiB.
TEST(RenderSequence, ASequenceOfTwoThousandMillionFramesStarts) {
    const TemporaryFolder folder;
#if defined(__SANITIZE_ADDRESS__)
    std::vector<std::string> words;  // the sanitizer's own map is larger than such a limit
#else
    std::vector<std::string> words = {"/usr/bin/prlimit", "--as=7000000000"};
#endif
    words.push_back(program_file());
    const auto render = small_sequence(folder / "f.#.exr", {"--frames", "0:2147483647", "-q"});
    words.insert(words.end(), render.begin(), render.end());
    const ChildResult result = run_child(words, [&](pid_t child) {
        wait_for(folder / "f.0.exr");
        kill(child, SIGINT);
    });
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_TRUE(names_in(folder).contains("f.0.exr"));
}

// OpenGL on a CPU draws such a picture in minutes.
TEST(RenderSequence, ASignalEndsAPictureThatOpenGlDraws) {
    const TemporaryFolder folder;
    const std::vector<std::string> words = {"render",
                                            "atrium",
                                            "--renderer",
                                            "forward",
                                            "--lights",
                                            "60000",
                                            "--resolution",
                                            "1280,720",
                                            "--quiet",
                                            "-o",
                                            (folder / "a.png").string()};
    std::chrono::steady_clock::time_point sent;
    const ChildResult result = run_kilolux(words, [&](pid_t child) {
        const timespec compiled{5, 0};
        nanosleep(&compiled, nullptr);
        sent = std::chrono::steady_clock::now();
        kill(child, SIGTERM);
    });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - sent;
    if (result.code == 0) GTEST_SKIP() << "this OpenGL draws it in less";
    EXPECT_EQ(result.code, 143) << "signal " << result.signal << " " << result.err;
    EXPECT_EQ(result.err, "kilolux: interrupted\n");
    EXPECT_LT(taken.count(), 30.0) << "of minutes";
    EXPECT_TRUE(names_in(folder).empty());
}

TEST(RenderSequence, ASignalEndsASequenceBetweenFrames) {
    for (const int number : {SIGINT, SIGTERM}) {
        const TemporaryFolder folder;
        const auto words = small_sequence(folder / "f.#.exr", {"--frames", "0:1000000", "--quiet"});
        const ChildResult result = run_kilolux(words, [&](pid_t child) {
            wait_for(folder / "f.0.exr");
            kill(child, number);
        });
        EXPECT_EQ(result.code, 128 + number) << "signal " << result.signal << " " << result.err;
        EXPECT_EQ(result.err, "kilolux: interrupted\n");
        for (const std::string& name : names_in(folder)) {
            EXPECT_TRUE(name.starts_with("f.")) << name;
            EXPECT_EQ(read_image(folder / name).width, 48) << name;
        }
    }
}

}  // namespace
}  // namespace kilolux
