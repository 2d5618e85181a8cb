// SPDX-License-Identifier: Apache-2.0
// Uses `kilolux view` like a user: real window, real events, pictures of the screen. Under Xvfb.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "host/picture/views.h"
#include "present/cli/names.h"
#include "present/window/script/script.h"
#include "present/window/script/script_player.h"
#include "tests/support/paths.h"
#include "tests/window/expected_picture.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

// Plays a session and expects that neither OpenGL, OpenCL nor the program complains: an error
// during a script ends it with a message.
void play(const Script& script) {
    const ChildResult result = view_in_display({}, small_window(script.write()));
    ASSERT_EQ(result.code, 0) << result.err << result.out;
    EXPECT_EQ(result.err, "");
}

// The camera that the README's keys promise, by formulas instead of CameraRig: an eye, a direction
// by its angles, and the distance to the point that it orbits about.
struct Flight {
    explicit Flight(const Camera& start, const Box& box)
        : radius(0.5 * glm::length(box.size())), middle(box.center()), first(start) {
        reset();
    }
    void reset() {
        const glm::dvec3 ahead = -first.world_from_view[2];
        eye = first.position;
        yaw = std::atan2(ahead.x, -ahead.z);
        pitch = std::asin(ahead.y);
        distance = glm::length(middle - eye);
    }
    glm::dvec3 ahead() const {
        return {std::cos(pitch) * std::sin(yaw), std::sin(pitch), -std::cos(pitch) * std::cos(yaw)};
    }
    // 0.12 scene radii a second.
    void fly(double seconds) { eye += 0.12 * radius * seconds * ahead(); }
    // 2.2 radians for the window's height at 45 degrees.
    void look(double right, double down) {
        const double per_pixel = 2.2 * first.y_fov / glm::radians(45.0) / 420.0;
        yaw += per_pixel * right;
        pitch -= per_pixel * down;
    }
    void orbit(double right, double clicks) {
        const glm::dvec3 focal = eye + distance * ahead();
        yaw += 4.4 / 420.0 * right;
        distance *= std::pow(0.88, clicks);
        eye = focal - distance * ahead();
    }
    void frame() {
        distance = radius / std::sin(0.5 * first.y_fov);
        eye = middle - distance * ahead();
    }
    Camera camera() const {
        return place_camera({eye, eye + distance * ahead(), {0, 1, 0}}, first.y_fov, radius);
    }

    double radius;  // of the scene [m]
    glm::dvec3 middle;
    Camera first;
    glm::dvec3 eye{};
    double yaw = 0.0, pitch = 0.0;  // [rad]
    double distance = 0.0;          // [m]
};

TEST(Window, MovesTheCameraByKeysAndMouse) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("key W 0.4").shot("forward");
    script.line("drag 450 250 530 280").shot("looked");
    script.line("key R 0").shot("reset");
    script.line("key O 0").line("drag 450 250 520 250").shot("orbited");
    script.line("wheel 4").shot("zoomed");
    script.line("key F 0").shot("framed");
    play(script);
    ExpectedPicture expected;
    Flight flight(expected.camera(), expected.box());
    const auto expect = [&](const char* name, const Camera& camera) {
        expect_same_picture(folder / (std::string(name) + ".png"), expected.of(camera));
    };
    expect("start", expected.camera());
    // The key is down for 12 frames after the one that presses it.
    flight.fly(13.0 / 30.0);
    expect("forward", flight.camera());
    flight.look(80.0, 30.0);
    expect("looked", flight.camera());
    flight.reset();
    expect("reset", expected.camera());
    flight.orbit(70.0, 0.0);
    expect("orbited", flight.camera());
    flight.orbit(0.0, 4.0);
    expect("zoomed", flight.camera());
    flight.frame();
    expect("framed", flight.camera());
}

TEST(Window, ShowsThePictureOfEveryRenderer) {
    const TemporaryFolder folder;
    Script script(folder);
    for (const std::string& name : names_of<RendererKind>()) {
        script.line("choose renderer " + name).shot(name);
    }
    play(script);
    ExpectedPicture expected;
    for (int i = 0; const std::string& name : names_of<RendererKind>()) {
        const auto renderer = static_cast<RendererKind>(i++);
        expect_same_picture(folder / (name + ".png"),
                            expected.of([&](RenderSettings& s) { s.renderer = renderer; }));
    }
    EXPECT_EQ(mean_difference(scene_part(folder / "deferred.png"),
                              scene_part(folder / "deferred-all.png")),
              0.0);
}

TEST(Window, ShowsEveryView) {
    const TemporaryFolder folder;
    Script script(folder);
    std::vector<std::string> names = view_names();
    std::erase(names, "shadows");  // takes --shadows exact
    for (const std::string& name : names) {
        script.line("choose show " + name).line("away").shot(name);
    }
    play(script);
    ExpectedPicture expected;
    for (const std::string& name : names) {
        expect_same_picture(folder / (name + ".png"), expected.of([&](RenderSettings& s) {
            s.want.view = parse_view(name);
        }));
    }
}

TEST(Window, SlidersAndTextReachThePicture) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("slide exposure -4").shot("dark").line("type exposure 0");
    script.line("slide lights 20000").line("away").shot("lights");
    script.line("type lights 150").line("choose tone map aces").line("away").shot("aces");
    script.line("slide bloom 0.6").line("away").shot("bloom");
    play(script);
    ExpectedPicture expected;
    const auto expect = [&](const char* name, const std::function<void(RenderSettings&)>& change) {
        expect_same_picture(folder / (std::string(name) + ".png"), expected.of(change));
    };
    expect("dark", [](RenderSettings& s) { s.exposure = -4.0f; });
    expect("lights", [](RenderSettings& s) { s.lights.count = 20000; });
    expect("aces", [](RenderSettings& s) { s.tone_curve = ToneCurve::aces; });
    expect("bloom", [](RenderSettings& s) {
        s.tone_curve = ToneCurve::aces;
        s.bloom = 0.6f;
    });
}

TEST(Window, ResizesAndHidesItsPanel) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("resize 820 500").shot("large").line("resize 620 380").shot("small");
    script.line("key Tab 0").shot("bare").line("key H 0").line("frames 3").shot("help");
    play(script);
    EXPECT_EQ(scene_part(folder / "start.png").width, 700);
    EXPECT_EQ(scene_part(folder / "large.png").width, 820);
    EXPECT_EQ(scene_part(folder / "large.png").height, 500);
    EXPECT_EQ(scene_part(folder / "small.png").height, 380);
    const auto left_of = [](const fs::path& file) { return scene_part(file, 0); };
    EXPECT_GT(mean_difference(left_of(folder / "small.png"), left_of(folder / "bare.png")), 0.01);
    EXPECT_GT(mean_difference(left_of(folder / "bare.png"), left_of(folder / "help.png")), 0.01);
}

// Pixels of the screenshot's rectangle that differ from the other, and how many of them are nearly
// white.
struct Changes {
    int changed = 0, white = 0;
};
Changes changes(const fs::path& before, const fs::path& after, const std::array<int, 4>& place) {
    const FloatImage a = read_image(before), b = read_image(after);
    const std::size_t channels = a.channels.size();
    Changes out;
    for (int y = place[1]; y < place[1] + place[3]; ++y) {
        for (int x = place[0]; x < place[0] + place[2]; ++x) {
            const std::size_t at = channels * static_cast<std::size_t>(y * a.width + x);
            const auto is = [&](const FloatImage& image) {
                return std::array{image.values[at], image.values[at + 1], image.values[at + 2]};
            };
            const auto colour = is(b);
            if (colour == is(a)) continue;
            ++out.changed;
            out.white += *std::min_element(colour.begin(), colour.end()) > 0.7f;
        }
    }
    return out;
}

TEST(Window, LooksIntoClusters) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("resize 1000 700")
        .shot("start")
        .line("key X 0")
        .line("move 700 300")
        .shot("probed");
    script.line("key X 0").shot("after").line("key G 0").shot("frozen");
    script.line("key S 0.3").shot("flown").line("key G 0").shot("thawed");
    play(script);
    const auto file = [&](const char* name) { return folder / (std::string(name) + ".png"); };
    // The active cluster's box is white and about a tile large. Its lists stand in the lower right.
    const Changes box = changes(file("start"), file("probed"), {660, 260, 80, 80});
    EXPECT_GT(box.white, 15);
    EXPECT_LT(box.changed, 80 * 80 / 2);
    EXPECT_GT(changes(file("start"), file("probed"), {590, 640, 400, 50}).changed, 400 * 45);
    EXPECT_EQ(changes(file("start"), file("after"), {360, 0, 640, 700}).changed, 0);
    // Lines over the same picture. They stay at their place in the scene.
    const int lines = changes(file("start"), file("frozen"), {360, 120, 640, 580}).changed;
    EXPECT_GT(lines, 2000);
    EXPECT_LT(lines, 640 * 580 * 9 / 10);
    EXPECT_GT(changes(file("thawed"), file("flown"), {360, 120, 640, 580}).changed, 2000);
    EXPECT_GT(changes(file("start"), file("thawed"), {360, 120, 640, 580}).changed, 640 * 580 / 10);
}

// In the smallest window with a picture nothing over the picture may run off it.
TEST(Window, WhatLiesOverThePictureFitsIntoASmallWindow) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("resize 640 400").shot("start").line("key H 0").shot("help").line("key H 0");
    script.line("key X 0").line("move 500 300").shot("probed");
    script.line("key X 0").line("key G 0").shot("frozen");
    play(script);
    const auto file = [&](const char* name) { return folder / (std::string(name) + ".png"); };
    // The help lies within the window: its edges are as before.
    for (const auto& edge :
         {std::array{0, 0, 640, 3}, {0, 397, 640, 3}, {0, 0, 3, 400}, {637, 0, 3, 400}}) {
        EXPECT_EQ(changes(file("start"), file("help"), edge).changed, 0)
            << edge[0] << "," << edge[1];
    }
    EXPECT_GT(changes(file("start"), file("help"), {20, 40, 600, 320}).changed, 600 * 320 / 2);
    // The probe's lists lie within the picture, not over the panel.
    EXPECT_EQ(changes(file("start"), file("probed"), {0, 0, 360, 400}).changed, 0);
    EXPECT_EQ(changes(file("start"), file("probed"), {637, 0, 3, 400}).changed, 0);
    EXPECT_GT(changes(file("start"), file("probed"), {380, 340, 240, 40}).changed, 240 * 40 / 2);
    // The legend of the boxes' colours is in the lower left: a bar from dark violet to pale yellow,
    // of steps that are wider than the boxes' lines.
    const FloatImage frozen = read_image(file("frozen"));
    std::set<std::array<float, 3>> colours;
    std::array<float, 3> last{};
    int width = 0;
    for (int x = 370; x < 600; ++x) {
        const auto at = frozen.channels.size() * static_cast<std::size_t>(382 * 640 + x);
        const std::array<float, 3> p = {frozen.values[at], frozen.values[at + 1],
                                        frozen.values[at + 2]};
        width = p == last ? width + 1 : 1;
        last = p;
        if (width == 4 && p[0] > 1.5f * p[1] && p[0] > 0.2f) colours.insert(p);
    }
    EXPECT_GE(colours.size(), 8u);
}

// Relative luminance of a colour of sRGB, by WCAG 2.1.
double luminance(const std::array<float, 3>& colour) {
    constexpr double kWeights[] = {0.2126, 0.7152, 0.0722};
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double v = colour[c];
        sum += kWeights[c] * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return sum;
}

// At 0 the grip of the exposure lies under the digits, which are white.
TEST(Window, DigitsAreReadableOverAGrip) {
    constexpr double kReadable = 4.5;  // contrast of small text, WCAG 2.1
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("middle").line("type exposure -6").line("away").shot("left");
    play(script);
    const FloatImage middle = read_image(folder / "middle.png");
    const FloatImage left = read_image(folder / "left.png");
    const auto colour = [](const FloatImage& image, int x, int y) {
        const auto at = image.channels.size() * static_cast<std::size_t>(y * image.width + x);
        return std::array{image.values[at], image.values[at + 1], image.values[at + 2]};
    };
    const auto is_amber = [](const std::array<float, 3>& c) {
        return c[0] > 1.2f * c[1] && c[1] > 1.2f * c[2];
    };
    std::map<std::array<float, 3>, int> moved;
    for (int y = 0; y < middle.height; ++y) {
        for (int x = 0; x < kPanel; ++x) {
            const std::array<float, 3> seen = colour(middle, x, y);
            if (is_amber(seen) && !is_amber(colour(left, x, y))) ++moved[seen];
        }
    }
    const auto grip = std::ranges::max_element(moved, {}, [](const auto& m) { return m.second; });
    ASSERT_NE(grip, moved.end());
    EXPECT_GT(grip->second, 50) << "pixels of a grip";
    EXPECT_GT(1.05 / (luminance(grip->first) + 0.05), kReadable);
}

TEST(Window, SaysWhichRendererHasNoClusters) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("choose renderer forward").line("settle").line("key G 0").line("settle");
    const ChildResult result = view_in_display({}, small_window(script.write()));
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_NE(result.err.find("only the renderer deferred"), std::string::npos) << result.err;
}

TEST(Window, MeasuresItsErrorAndShowsAMap) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start")
        .line("open error")
        .line("click measure error")
        .line("away")
        .shot("measured");
    script.line("click error map")
        .line("away")
        .shot("map")
        .line("type exposure 1")
        .line("away")
        .shot("other");
    play(script);
    const ScenePart start = scene_part(folder / "start.png");
    EXPECT_EQ(mean_difference(start, scene_part(folder / "measured.png")), 0.0);
    // The heat map's colours and nothing else: green never exceeds both red and blue.
    const ScenePart map = scene_part(folder / "map.png");
    std::set<std::array<float, 3>> colours;
    int green = 0;
    for (std::size_t i = 0; i + 2 < map.values.size(); i += 3) {
        const float r = map.values[i], g = map.values[i + 1], b = map.values[i + 2];
        colours.insert({r, g, b});
        green += g > std::max(r, b) + 0.02f;
    }
    EXPECT_EQ(green, 0);
    EXPECT_GT(colours.size(), 20u);
    EXPECT_GT(mean_difference(start, map), 0.05);
    // The error map belongs to the measured picture; any other picture is shown itself.
    ExpectedPicture expected;
    expect_same_picture(folder / "other.png",
                        expected.of([](RenderSettings& s) { s.exposure = 1.0f; }));
}

TEST(Window, NoticesFade) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("key C 0").line("frames 9").shot("notice");
    script.line("frames 200").shot("faded");
    play(script);
    const std::array<int, 4> overlay = {360, 0, 340, kUnderlay};
    EXPECT_GT(changes(folder / "start.png", folder / "notice.png", overlay).changed, 500);
    EXPECT_EQ(changes(folder / "start.png", folder / "faded.png", overlay).changed, 0);
}

TEST(Window, SettlingWhileTheLightsMoveEndsWithAMessage) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("key Space 0").line("settle");
    const ChildResult result = view_in_display({}, small_window(script.write()));
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_NE(result.err.find("script:2"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("lights move"), std::string::npos) << result.err;
}

TEST(Window, SettlesWhileItRendersAlways) {
    const TemporaryFolder folder;
    Script script(folder);
    const auto later = [&](const std::string& name) {
        script.shot(name).line("frames 60");
        script.line("screenshot " + (folder / (name + "-later.png")).string());
    };
    later("rest");
    script.line("open window").line("click render always").line("away");
    script.line("type exposure 1").line("away");
    later("shown");
    play(script);
    // The overlay has the median of the pictures' times.
    const std::array<int, 4> overlay = {360, 0, 340, kUnderlay};
    EXPECT_EQ(changes(folder / "rest.png", folder / "rest-later.png", overlay).changed, 0);
    EXPECT_GT(changes(folder / "shown.png", folder / "shown-later.png", overlay).changed, 0);
    ExpectedPicture expected;
    expect_same_picture(folder / "shown.png",
                        expected.of([](RenderSettings& s) { s.exposure = 1.0f; }));
}

// At rest the picture gets one sample after the other, and has the bits of `render --samples`; any
// movement begins it anew.
TEST(Window, RefinesItsPictureAtRest) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("first").line("drag 500 300 560 320").line("frames 2").shot("turned");
    script.line("key R 0").shot("again");
    script.line("choose show albedo").shot("albedo");
    auto words = small_window(script.write());
    words.insert(words.end(), {"--samples", "4"});
    const ChildResult result = view_in_display({}, words);
    ASSERT_EQ(result.code, 0) << result.err;
    ExpectedPicture expected;
    const auto four = [](RenderSettings& s) { s.samples = 4; };
    expect_same_picture(folder / "first.png", expected.of(four));
    expect_same_picture(folder / "again.png", expected.of(four));
    EXPECT_GT(mean_difference(scene_part(folder / "first.png"), expected.of()), 1e-4);
    EXPECT_GT(mean_difference(scene_part(folder / "turned.png"), expected.of(four)), 1e-2);
    expect_same_picture(folder / "albedo.png",
                        expected.of([](RenderSettings& s) { s.want.view = ViewKind::albedo; }));
}

TEST(Window, KeepsItsValues) {
    const TemporaryFolder folder;
    const std::string config = "XDG_CONFIG_HOME=" + folder.path().string();
    Script script(folder);
    script.line("type lights 77").line("choose show normal").line("resize 690 410").line("settle");
    auto words = small_window(script.write());
    std::erase(words, "--fresh");
    words.insert(words.end(), {"--exposure", "1"});
    ASSERT_EQ(view_in_display({config}, words).code, 0);
    const auto kept = nlohmann::json::parse(text_of_file(folder / "kilolux" / "view.json"));
    EXPECT_EQ(kept.at("lights"), 77);
    EXPECT_EQ(kept.at("show"), "normal");
    EXPECT_EQ(kept.at("exposure"), 0.0) << "from the command line, not changed in the window";
    const std::string again = (folder / "again.png").string();
    const ChildResult result = view_in_display(
        {config}, {"view", "plain", "-q", "--exit-after", "2", "--screenshot", again});
    ASSERT_EQ(result.code, 0) << result.err;
    // A view of normals differs from the lit picture: blue is never 0 on surfaces that face the
    // camera.
    EXPECT_GT(mean_of(scene_part(again)), 0.1);
    EXPECT_EQ(read_image(again).width, 690);
}

TEST(Window, GoesBackToItsDefaults) {
    const auto kept_after = [](const std::vector<std::string>& lines) {
        const TemporaryFolder folder;
        Script script(folder);
        script.line("settle");
        for (const std::string& line : lines) script.line(line);
        const ChildResult result = view_in_display(
            {"XDG_CONFIG_HOME=" + folder.path().string()},
            {"view", "plain", "-q", "--resolution", "700,420", "--script", script.write()});
        EXPECT_EQ(result.code, 0) << result.err;
        return nlohmann::json::parse(text_of_file(folder / "kilolux" / "view.json"));
    };
    const std::vector<std::string> changes = {
        "type lights 77", "choose show normal", "choose tone map aces", "choose rig studio",
        "settle",  // results move the panel's buttons
        "open window",    "click vsync"};
    std::vector<std::string> changes_and_back = changes;
    changes_and_back.emplace_back("settle");
    changes_and_back.emplace_back("click all settings to their defaults");
    changes_and_back.emplace_back("settle");
    const auto untouched = kept_after({"frames 1"});
    EXPECT_NE(kept_after(changes), untouched);
    EXPECT_EQ(kept_after(changes_and_back), untouched);
}

TEST(Window, SaysInOneLineWhatIsMissing) {
    const auto one_line = [](const ChildResult& result, const std::string& word) {
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    };
    const std::vector<std::string> words = {"/usr/bin/env", "-uDISPLAY", "-uWAYLAND_DISPLAY",
                                            program_file(), "view",      "plain",
                                            "--fresh"};
    one_line(run_child(words), "kilolux render");
    const std::vector<std::string> view = {"view", "plain", "--fresh", "-q", "--exit-after", "1"};
    one_line(view_in_display({"MESA_GL_VERSION_OVERRIDE=3.3"}, view), "libgl1-mesa-dri");
    one_line(view_in_display({"OCL_ICD_VENDORS=/nonexistent"}, view), "pocl-opencl-icd");
}

TEST(Window, ScriptsSayWhatTheyDoNotUnderstand) {
    const TemporaryFolder folder;
    for (const auto& [text, word] :
         std::map<std::string, std::string>{{"clik vsync", "click"},
                                            {"drag 1 2", "drag"},
                                            {"key Hyper 1", "Hyper"},
                                            {"key Hyper+V 1", "Hyper"}}) {
        write_text(folder / "script", text + "\n");
        const ChildResult result = view_in_display({}, small_window((folder / "script").string()));
        EXPECT_EQ(result.code, 2) << result.err;
        EXPECT_NE(result.err.find("script:1"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    }
    write_text(folder / "script", "click nonsense\n");
    const ChildResult result = view_in_display({}, small_window((folder / "script").string()));
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_NE(result.err.find("nonsense"), std::string::npos) << result.err;
    write_text(folder / "script", "slide lights 2000000\n");
    const ChildResult beyond = view_in_display({}, small_window((folder / "script").string()));
    EXPECT_EQ(beyond.code, 1) << beyond.err;
    EXPECT_NE(beyond.err.find("1 to 1000000"), std::string::npos) << beyond.err;
}

}  // namespace
}  // namespace kilolux
