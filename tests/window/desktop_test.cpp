// SPDX-License-Identifier: Apache-2.0
// The window among others: a window manager minimises it, gives the focus to another, and makes it
// fill the screen. Keys come from the X server, pictures from its screen.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/window/desktop.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

// Another window, in the lower right corner of the screen. It takes the focus.
class OtherWindow {
 public:
    OtherWindow(const Desktop& desktop, const Viewer& viewer)
        : program_(with_variables({desktop.variable()}, {"xev", "-geometry", "60x60+920+620"})) {
        wait_for("the focus of another window", [&] {
            if (program_.has_ended()) throw std::runtime_error("xev: " + program_.result().err);
            return !viewer.has_focus();
        });
    }

 private:
    Background program_;
};

void leave(Viewer& viewer) {
    viewer.key("ctrl+q");
    const ChildResult result = viewer.program().result();
    EXPECT_EQ(result.code, 0) << result.signal;
    EXPECT_EQ(result.err, "");
}

TEST(Desktop, RestsWhileMinimised) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop);
    viewer.activate();
    viewer.final_picture();
    viewer.key("space");  // the lights move
    viewer.wait_for_change();
    viewer.minimise();
    viewer.wait_for_rest();
    const std::size_t rest = viewer.record().size();
    wait_for("more of it", [&] { return viewer.record().size() >= rest + 6; });
    // The window neither draws nor renders.
    const std::vector<std::string> calls = viewer.record();
    for (std::size_t i = rest; i < calls.size(); ++i) EXPECT_EQ(calls[i], "wait 0.250") << i;
    viewer.activate();
    viewer.wait_for_change();
    viewer.key("space");
    leave(viewer);
}

TEST(Desktop, DrawsNothingWhileNothingHappens) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop);
    viewer.activate();
    viewer.final_picture();
    const std::size_t swaps = viewer.count("swap");
    const std::size_t waits = viewer.count("wait 0.250");
    wait_for("more of it", [&] { return viewer.count("wait 0.250") >= waits + 6; });
    EXPECT_EQ(viewer.count("swap"), swaps);
    leave(viewer);
}

TEST(Desktop, FreezesClustersAfterItCouldNot) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop);
    viewer.activate();
    viewer.final_picture();
    viewer.key("3");  // forward: no clusters
    viewer.final_picture();
    viewer.key("g");
    viewer.wait_for_change();  // a message
    viewer.key("1");
    const Seen before = viewer.final_picture();
    viewer.key("g");
    wait_for("boxes", [&] { return viewer.final_picture() != before; });
    leave(viewer);
}

TEST(Desktop, LeavesWhileAPictureIsMade) {
    const Desktop desktop({"--manager"});
    // One that takes minutes.
    Viewer viewer(desktop, {"--renderer", "deferred-all", "--lights", "1000000"});
    viewer.activate();
    leave(viewer);
}

// llvmpipe draws the window and the picture with the same threads: a picture that takes minutes
// comes in parts, and the window has its turn between them.
TEST(Desktop, AnswersWhileAForwardPictureIsMade) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop, {"--renderer", "forward", "--lights", "20000"});
    viewer.activate();
    const auto frames = [&viewer](std::size_t more) {
        const std::size_t swaps = viewer.count("swap");
        wait_for("frames", [&] { return viewer.count("swap") >= swaps + more; });
    };
    frames(2);  // each counts the seconds
    viewer.key("h");
    viewer.wait_for_change();  // the help, while there is no picture yet
    frames(2);
    EXPECT_FALSE(viewer.program().has_ended());
    viewer.key("1");  // another renderer: the picture is given up
    viewer.key("h");
    viewer.final_picture();
    leave(viewer);
}

// A test that waits for rest then sees the picture with all its samples.
TEST(Desktop, DoesNotRestWhileAPictureIsMade) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop, {"--renderer", "deferred-all", "--lights", "1000000"});
    viewer.activate();
    wait_for("short waits", [&] { return viewer.count("wait 0.100") >= 15; });
    EXPECT_EQ(viewer.count("wait 0.250"), 0u);
    leave(viewer);
}

TEST(Desktop, KeepsItsSettingsWhenTheDisplayIsLost) {
    const TemporaryFolder folder;
    const fs::path file = folder / "kilolux" / "view.json";
    std::optional<Desktop> desktop(std::in_place, std::vector<std::string>{"--manager"});
    Background program(
        with_variables({desktop->variable(), "XDG_CONFIG_HOME=" + folder.path().string()},
                       {program_file(), "view", "plain", "--quiet", "--resolution", "560,330",
                        "--lights", "100"}));
    std::string window;
    wait_for("the window", [&] {
        return desktop->try_tool({"xdotool", "search", "--onlyvisible", "--name", "^Kilolux - "},
                                 window);
    });
    window = window.substr(0, window.find('\n'));
    desktop->tool({"xdotool", "windowactivate", "--sync", window});
    desktop->tool({"xdotool", "key", "space"});
    wait_for("the settings", [&] {
        return fs::exists(file) &&
               text_of_file(file).find("\"lights-move\": true") != std::string::npos;
    });
    desktop.reset();
    const ChildResult result = program.result();
    EXPECT_EQ(result.code, 1) << "signal " << result.signal;
    EXPECT_EQ(result.err, "kilolux: window: the display was closed\n");
    EXPECT_NE(text_of_file(file).find("\"lights-move\": true"), std::string::npos);
}

TEST(Desktop, ComesBackFromMinimisedAsItWas) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop);
    viewer.activate();
    const Seen before = viewer.final_picture();
    const Place picture = viewer.picture();
    viewer.minimise();
    viewer.wait_for_rest();
    EXPECT_NE(desktop.see(picture), before);
    viewer.activate();
    viewer.wait_for_picture(before);
    leave(viewer);
}

TEST(Desktop, CountsItsPicturesWhileMinimised) {
    const TemporaryFolder folder;
    const fs::path file = folder / "end.png";
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop, {"--exit-after", "120", "--screenshot", file.string()});
    // Stopped, so that it cannot end before it is minimised.
    viewer.program().signal(SIGSTOP);
    viewer.minimise();
    viewer.program().signal(SIGCONT);
    const ChildResult result = viewer.program().result();
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_GE(viewer.count("wake"), 120u);
    const ScenePart end = scene_part(file);
    EXPECT_EQ(end.width, 560);
    EXPECT_EQ(end.height, 330);
    EXPECT_GT(mean_of(end), 0.01);
}

TEST(Desktop, LetsKeysGoWithTheFocus) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop);
    viewer.activate();
    const Seen start = viewer.final_picture();
    desktop.tool({"xdotool", "keydown", "w"});
    viewer.wait_for_change();
    const OtherWindow other(desktop, viewer);
    // The key is still down, but for another window: the camera comes to rest.
    const Seen flown = viewer.final_picture();
    EXPECT_NE(flown, start);
    desktop.tool({"xdotool", "keyup", "w"});
    EXPECT_EQ(viewer.final_picture(), flown);
    viewer.activate();
    EXPECT_EQ(viewer.final_picture(), flown);
    viewer.key("r");
    viewer.wait_for_picture(start);
    leave(viewer);
}

TEST(Desktop, GoesOnWithoutTheFocus) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop);
    viewer.activate();
    viewer.final_picture();
    viewer.key("space");
    viewer.wait_for_change();
    {
        const OtherWindow other(desktop, viewer);
        const std::size_t pictures = viewer.count("wake");
        wait_for("more pictures", [&] { return viewer.count("wake") > pictures + 10; });
        viewer.wait_for_change();
    }
    viewer.activate();
    viewer.key("space");
    viewer.final_picture();
    leave(viewer);
}

class FullScreen : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(FullScreen, FillsTheScreenAndComesBack) {
    const Desktop desktop(GetParam());
    Viewer viewer(desktop);
    viewer.final_picture();
    if (!GetParam().empty()) viewer.activate();
    const Place first = viewer.place();
    // Its own --sync has no limit.
    desktop.tool({"xdotool", "windowmove", viewer.window(), "150", "90"});
    wait_for("the move", [&] { return viewer.place() != first; });
    const Seen before = viewer.final_picture();
    const Place windowed = viewer.place();
    viewer.key("F11");
    wait_for("full screen", [&] { return viewer.place() == desktop.place(); });
    const Seen full = viewer.final_picture();
    const Place screen = desktop.place();
    EXPECT_EQ(full.width, screen.width - kPanel);
    // The picture reaches the screen's right and lower edges.
    const Seen right = desktop.see({screen.width - 4, kUnderlay, 4, screen.height - kUnderlay});
    const Seen lower = desktop.see({kPanel, screen.height - 4, screen.width - kPanel, 4});
    EXPECT_GT(count_colours(right), 30u);
    EXPECT_GT(count_colours(lower), 30u);
    viewer.key("F11");
    wait_for("the window's place", [&] { return viewer.place() == windowed; });
    viewer.wait_for_picture(before);
    leave(viewer);
}

INSTANTIATE_TEST_SUITE_P(Desktop, FullScreen,
                         testing::Values(std::vector<std::string>{},
                                         std::vector<std::string>{"--manager"}),
                         [](const auto& about) {
                             return about.param.empty() ? "Bare" : "WithWindowManager";
                         });

TEST(Desktop, StaysInFullScreenWithoutTheFocus) {
    const Desktop desktop({"--manager"});
    Viewer viewer(desktop);
    viewer.activate();
    viewer.final_picture();
    viewer.key("F11");
    wait_for("full screen", [&] { return viewer.place() == desktop.place(); });
    viewer.final_picture();
    const OtherWindow other(desktop, viewer);
    viewer.final_picture();
    EXPECT_FALSE(viewer.is_minimised());
    viewer.activate();
    leave(viewer);
}

}  // namespace
}  // namespace kilolux
