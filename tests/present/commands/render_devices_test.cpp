// SPDX-License-Identifier: Apache-2.0
// Sequences and pictures that several devices make: PoCL, asked for twice, is two equal devices.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include <signal.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/images/images.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

class RenderDevices : public testing::Test {
 protected:
    // Frames of a small scene.
    std::vector<std::string> words(const fs::path& output, const std::string& devices,
                                   const std::string& frames = "0:6",
                                   const std::string& size = "48,32") const {
        return {"/usr/bin/env", "POCL_DEVICES=pthread pthread",
                program_file(), "render",
                "grid",         "--resolution",
                size,           "--lights",
                "20",           "--geometry",
                "compute",      "--frames",
                frames,         "--device",
                devices,        "-o",
                output.string()};
    }
    ChildResult render(const fs::path& output, const std::string& devices,
                       const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = words(output, devices);
        all.insert(all.end(), more.begin(), more.end());
        return run_child(all);
    }

    // One picture.
    std::vector<std::string> picture_words(const fs::path& output,
                                           const std::string& devices) const {
        std::vector<std::string> all = words(output, devices, "", "150,131");
        all.erase(std::ranges::find(all, "--frames"), std::ranges::find(all, "--device"));
        return all;
    }

    TemporaryFolder one_, two_;
};

TEST_F(RenderDevices, MakeTheFilesOfOne) {
    for (const char* name : {"f.#.png", "f.#.exr"}) {
        ASSERT_EQ(render(one_ / name, "0").code, 0);
        const ChildResult result = render(two_ / name, "all");
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_TRUE(contains(result.err, "\ndevice 1 (")) << result.err;
    }
    ASSERT_EQ(names_in(one_).size(), 14u);
    EXPECT_EQ(names_in(two_), names_in(one_));
    for (const std::string& name : names_in(one_)) {
        EXPECT_EQ(text_of_file(two_ / name), text_of_file(one_ / name)) << name;
    }
}

TEST_F(RenderDevices, OneThatStandsTwiceMakesTwoFramesAtOnce) {
    ASSERT_EQ(render(one_ / "f.#.png", "0").code, 0);
    const ChildResult result = render(two_ / "f.#.png", "0,0", {"--stats", "-"});
    ASSERT_EQ(result.code, 0) << result.err;
    const auto devices = nlohmann::json::parse(result.out).at("devices");
    ASSERT_EQ(devices.size(), 2u);
    for (const auto& each : devices) EXPECT_EQ(each.at("index"), "0");
    EXPECT_EQ(devices[0].at("pictures").get<int>() + devices[1].at("pictures").get<int>(), 7);
    for (const std::string& name : names_in(one_)) {
        EXPECT_EQ(text_of_file(two_ / name), text_of_file(one_ / name)) << name;
    }
}

// One picture: its rows go to both devices.
TEST_F(RenderDevices, MakeThePictureOfOne) {
    const std::vector<std::pair<const char*, std::vector<std::string>>> cases = {
        {"a.png", {"--samples", "200"}},  // so long that both make rows
        {"b.png", {"--bloom", "0.3", "--exposure", "auto", "--geometry", "ids"}},
        {"c.png", {"--background", "none"}},
        {"d.exr", {"--aov", "depth,normal,light-count"}},
        {"e.exr", {"--samples", "auto", "--aov", "sample-count"}},
        {"h.exr",
         {"--samples", "3", "--rig", "studio", "--light-groups",
          "sun=kind:directional,swarm=kind:point", "--light-mix", "sun=0.5:1,0.5,0.25"}},
        {"f.png", {"--show", "overdraw", "--geometry", "ids"}},
        {"g.png", {"--show", "difference"}}};
    for (const auto& [name, options] : cases) {
        SCOPED_TRACE(name);
        std::vector<std::string> one = picture_words(one_ / name, "0");
        std::vector<std::string> two = picture_words(two_ / name, "all");
        for (std::vector<std::string>* all : {&one, &two})
            all->insert(all->end(), options.begin(), options.end());
        ASSERT_EQ(run_child(one).code, 0);
        const ChildResult result = run_child(two);
        ASSERT_EQ(result.code, 0) << result.err;
        for (const char* device : {"\ndevice 0 (", "\ndevice 1 ("}) {
            EXPECT_TRUE(contains(result.err, device)) << result.err;
        }
        EXPECT_FALSE(name == cases[0].first && contains(result.err, ": 131 rows in "))
            << "one made all\n"
            << result.err;
        EXPECT_TRUE(text_of_file(two_ / name) == text_of_file(one_ / name));
    }
}

// The statistics are those of the slowest device, with each device's part.
TEST_F(RenderDevices, TellWhatEachDidOfAPicture) {
    std::vector<std::string> words = picture_words(two_ / "a.png", "0,1");
    words.insert(words.end(), {"--samples", "200", "--stats", (two_ / "s.json").string()});
    const ChildResult result = run_child(words);
    ASSERT_EQ(result.code, 0) << result.err;
    const auto stats = nlohmann::json::parse(text_of_file(two_ / "s.json"));
    const auto& devices = stats.at("devices");
    ASSERT_EQ(devices.size(), 2u);
    EXPECT_EQ(devices[0].at("rows").get<int>() + devices[1].at("rows").get<int>(), 131);
    const double first = devices[0].at("rows_ms"), second = devices[1].at("rows_ms");
    const double frame = stats.at("frame_ms");
    EXPECT_GE(frame, std::max(first, second));
    EXPECT_LT(frame, first + second);
}

// Heights are multiples of 16: of 131 rows 80, then 51.
TEST_F(RenderDevices, MakeEqualSharesWhereTheyAreEqualGpus) {
    std::vector<std::string> words = picture_words(one_ / "a.png", "all");
    words.insert(words.begin() + 1, "KILOLUX_DEVICE_KIND=gpu");
    words.insert(words.end(), {"--samples", "200"});  // so long that both make rows
    const ChildResult result = run_child(words);
    ASSERT_EQ(result.code, 0) << result.err;
    for (const char* rows : {": 80 rows in ", ": 51 rows in "}) {
        EXPECT_TRUE(contains(result.err, rows)) << result.err;
    }
}

TEST_F(RenderDevices, LeaveNothingOfAPictureThatIsInterrupted) {
    std::vector<std::string> words = picture_words(two_ / "a.png", "0,1");
    words.insert(words.end(), {"--samples", "65536"});
    const ChildResult result = run_child(words, [](pid_t child) {
        sleep(2);
        kill(child, SIGTERM);
    });
    EXPECT_EQ(result.code, 143) << result.err;
    EXPECT_FALSE(contains(result.err, "left out")) << "no device has failed\n" << result.err;
    EXPECT_TRUE(names_in(two_).empty());
}

// Devices that differ: one of PoCL's works in one thread.
TEST_F(RenderDevices, NoteAllThatMadeAPicture) {
    const auto made = [&](const std::string& devices, const std::vector<std::string>& more) {
        std::vector<std::string> words = picture_words(two_ / "a.exr", devices);
        words[1] = "POCL_DEVICES=pthread basic";
        words.insert(words.end(), {"--samples", "200"});
        words.insert(words.end(), more.begin(), more.end());
        return run_child(words);
    };
    const ChildResult refused = made("0,1", {});
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_TRUE(contains(refused.err, "--mixed-devices allows that")) << refused.err;
    const ChildResult alike = made("all", {"--samples", "1"});
    EXPECT_EQ(alike.code, 0) << alike.err;
    EXPECT_TRUE(contains(alike.err, "device  all like ")) << alike.err;
    EXPECT_TRUE(contains(alike.err, "; --mixed-devices also takes ")) << alike.err;
    const ChildResult result = made("all", {"--mixed-devices"});
    ASSERT_EQ(result.code, 0) << result.err;
    const std::unique_ptr<ImageReader> reader = open_image(two_ / "a.exr");
    std::string noted;
    for (const auto& [name, value] : reader->layout().attributes) {
        if (name == "kilolux:device") noted = std::get<std::string>(value);
    }
    for (const char* device : {"basic-", "; pthread-"})
        EXPECT_TRUE(contains(noted, device)) << noted;
}

TEST_F(RenderDevices, MakeAPictureByOneWhereOpenGlLights) {
    std::vector<std::string> words = picture_words(two_ / "a.png", "0,1");
    words.insert(words.end(), {"--renderer", "forward-plus", "--geometry", "ids"});
    const ChildResult result = run_child(words);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "one device makes the whole picture")) << result.err;
}

// So many frames that the second device, which begins later, has its part.
TEST_F(RenderDevices, ShareALongVideo) {
    const auto video = [&](const fs::path& file, const std::string& devices) {
        std::vector<std::string> all = words(file, devices, "0:119", "640,360");
        all.insert(all.end(), {"--samples", "4"});
        return run_child(all);
    };
    ASSERT_EQ(video(one_ / "f.y4m", "0").code, 0);
    const ChildResult result = video(two_ / "f.y4m", "0,1");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_FALSE(contains(result.err, ": 0 pictures")) << result.err;
    EXPECT_TRUE(text_of_file(two_ / "f.y4m") == text_of_file(one_ / "f.y4m"));
}

// OpenGL's contexts belong to threads.
TEST_F(RenderDevices, DrawWithOpenGlToo) {
    const std::vector<std::string> ids = {"--geometry", "ids", "--exposure", "auto"};
    ASSERT_EQ(render(one_ / "f.y4m", "1", ids).code, 0);
    const ChildResult result = render(two_ / "f.y4m", "1,0", ids);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(text_of_file(two_ / "f.y4m"), text_of_file(one_ / "f.y4m"));
}

TEST_F(RenderDevices, LeaveOutWhatIsThere) {
    ASSERT_EQ(render(two_ / "f.#.png", "0,1").code, 0);
    fs::remove(two_ / "f.3.png");
    write_text(two_ / "f.5.png", "");
    const ChildResult result = render(two_ / "f.#.png", "0,1", {"--skip-existing"});
    ASSERT_EQ(result.code, 0) << result.err;
    ASSERT_EQ(render(one_ / "f.#.png", "0").code, 0);
    for (const char* name : {"f.3.png", "f.5.png"})
        EXPECT_EQ(text_of_file(two_ / name), text_of_file(one_ / name)) << name;
}

// The names of the pictures in a folder, without files that a program has not finished.
std::set<std::string> pictures_in(const TemporaryFolder& folder) {
    std::set<std::string> names = names_in(folder);
    std::erase_if(names, [](const std::string& name) { return name.starts_with(".kilolux-"); });
    return names;
}

// Sends a signal once there are four pictures, or the program has ended.
auto at_four_pictures(const TemporaryFolder& folder, int signal) {
    return [&folder, signal](pid_t child) {
        while (pictures_in(folder).size() < 4 && waitpid(child, nullptr, WNOHANG) == 0)
            usleep(10'000);
        kill(child, signal);
    };
}

TEST_F(RenderDevices, EndTogetherWhenInterrupted) {
    const ChildResult result =
        run_child(words(two_ / "f.######.png", "0,1", "0:99999"), at_four_pictures(two_, SIGTERM));
    EXPECT_EQ(result.code, 143) << result.err;
    const std::size_t count = names_in(two_).size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::string number = std::to_string(i);
        EXPECT_TRUE(
            fs::exists(two_ / ("f." + std::string(6 - number.size(), '0') + number + ".png")))
            << "the first " << count << " and no other file";
    }
}

// The folder's pictures are those of one device; returns their number.
std::size_t expect_whole_pictures(const TemporaryFolder& folder, const TemporaryFolder& of_one) {
    const std::set<std::string> names = pictures_in(folder);
    for (const std::string& name : names)
        EXPECT_TRUE(text_of_file(folder / name) == text_of_file(of_one / name)) << name;
    return names.size();
}

TEST_F(RenderDevices, LeaveWholePicturesWhenKilled) {
    const ChildResult killed =
        run_child(words(two_ / "f.######.png", "0,1", "0:99999"), at_four_pictures(two_, SIGKILL));
    EXPECT_EQ(killed.signal, SIGKILL) << killed.err;
    const std::string frames = "0:" + std::to_string(names_in(two_).size() + 3);
    ASSERT_EQ(run_child(words(one_ / "f.######.png", "0", frames)).code, 0);
    EXPECT_GE(expect_whole_pictures(two_, one_), 4u);
    std::vector<std::string> rest = words(two_ / "f.######.png", "0,1", frames);
    rest.emplace_back("--skip-existing");
    const ChildResult result = run_child(rest);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(expect_whole_pictures(two_, one_), names_in(one_).size());
}

TEST_F(RenderDevices, NameThePictureThatHasNoRoom) {
    ASSERT_EQ(run_child(words(one_ / "f.##.png", "0", "0:30")).code, 0);
    if (mount("kilolux", two_.path().c_str(), "tmpfs", 0, "size=48k") != 0) {
        GTEST_SKIP() << "no permission to mount a tmpfs";
    }
    const ChildResult result = run_child(words(two_ / "f.##.png", "0,1", "0:30"));
    const std::size_t count = expect_whole_pictures(two_, one_);
    EXPECT_EQ(names_in(two_).size(), count) << "and no other file";
    EXPECT_EQ(umount(two_.path().c_str()), 0);
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_GT(count, 0u);
    EXPECT_LT(count, 31u);
    EXPECT_TRUE(contains(result.err, ".png: cannot write: No space left on device")) << result.err;
    EXPECT_FALSE(contains(result.err, "left out")) << "no device has failed\n" << result.err;
}

// Each holds the lights in its part of the memory: found before anything is loaded.
TEST_F(RenderDevices, HaveRoomForTheLightsEach) {
    const std::vector<std::string> lights = {"--lights", "1000000", "--max-memory", "900M"};
    EXPECT_EQ(render(one_ / "f.#.png", "0", lights).code, 0);
    const ChildResult two = render(two_ / "f.#.png", "0,1", lights);
    EXPECT_EQ(two.code, 1);
    EXPECT_TRUE(contains(two.err, "memory: the program and 1000000 generated lights need"))
        << two.err;
    EXPECT_TRUE(contains(two.err, "; 2 renderers share 900 MiB (--max-memory)")) << two.err;
}

TEST_F(RenderDevices, AreRefusedWhereTheyCannotShare) {
    const struct {
        std::string devices;
        const char* message;
    } cases[] = {{"0,7", "no device '7'"}, {"0,", "--device 0,: '' is no index"}};
    for (const auto& c : cases) {
        const ChildResult result = render(one_ / "f.y4m", c.devices);
        EXPECT_NE(result.code, 0);
        EXPECT_TRUE(contains(result.err, c.message)) << result.err;
        EXPECT_TRUE(names_in(one_).empty());
    }
}

}  // namespace
}  // namespace kilolux
