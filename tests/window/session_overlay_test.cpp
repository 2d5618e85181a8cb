// SPDX-License-Identifier: Apache-2.0
// What lies over the picture of the window: the probe of clusters, texts and grips. Under Xvfb.
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
    const PixelChanges box = changes(file("start"), file("probed"), {660, 260, 80, 80});
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

}  // namespace
}  // namespace kilolux
