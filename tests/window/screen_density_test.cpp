// SPDX-License-Identifier: Apache-2.0
// The window on a screen of twice the usual density, which X11 desktops announce by Xft.dpi.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

const std::vector<std::string> kUsual = {"--size", "1500x900", "--dpi", "96"};
const std::vector<std::string> kDense = {"--size", "1500x900", "--dpi", "192"};

// A rectangle from the upper left, with one value a pixel.
struct Gray {
    int width = 0, height = 0;
    std::vector<double> values;
    double at(int x, int y) const {
        return values.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(x));
    }
};

Gray gray_of(const fs::path& file, int width, int height) {
    const FloatImage image = read_image(file);
    Gray out{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x);
            out.values.push_back(
                static_cast<double>(image.values.at(pixel * image.channels.size() + 1)));
        }
    }
    return out;
}

// Means of 2 x 2 pixels.
Gray halved(const Gray& a) {
    Gray out{a.width / 2, a.height / 2, {}};
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            out.values.push_back(0.25 * (a.at(2 * x, 2 * y) + a.at(2 * x + 1, 2 * y) +
                                         a.at(2 * x, 2 * y + 1) + a.at(2 * x + 1, 2 * y + 1)));
        }
    }
    return out;
}

double mean_difference(const Gray& a, const Gray& b) {
    EXPECT_EQ(a.values.size(), b.values.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) sum += std::abs(a.values[i] - b.values[i]);
    return sum / static_cast<double>(a.values.size());
}

// Small windows of a new state that a script moves. Pictures that it saves lie in `folder`.
void play(const TemporaryFolder& folder, const Script& script,
          const std::vector<std::string>& display) {
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    const ChildResult result = view_in_display({}, small_window(script.write()), display);
    fs::current_path(before);
    ASSERT_EQ(result.code, 0) << result.err << result.out;
    EXPECT_EQ(result.err, "");
}

TEST(ScreenDensity, WindowPanelAndFontsAreTwiceAsLarge) {
    const TemporaryFolder folder;
    play(folder, Script(folder).shot("usual"), kUsual);
    play(folder, Script(folder).shot("dense"), kDense);
    const FloatImage dense = read_image(folder / "dense.png");
    EXPECT_EQ(dense.width, 1400);
    EXPECT_EQ(dense.height, 840);
    EXPECT_EQ(read_image(folder / "usual.png").width, 700);
    const Gray small = gray_of(folder / "usual.png", kPanel, 420);
    const Gray large = gray_of(folder / "dense.png", 2 * kPanel, 840);
    // Letters of 15 and of 30 pixels are hinted differently.
    EXPECT_LT(mean_difference(small, halved(large)), 0.04);
    EXPECT_GT(mean_difference(small, gray_of(folder / "dense.png", kPanel, 420)), 0.06);
}

TEST(ScreenDensity, ControlsAreHitAndThePictureHasEveryPixel) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("slide exposure -4").shot("dark");
    script.line("type exposure 0").line("choose show normal").shot("normal");
    script.line("key P 0").line("frames 3").line("settle");
    play(folder, script, kDense);
    const ScenePart start = scene_part(folder / "start.png", 2 * kPanel);
    EXPECT_LT(mean_of(scene_part(folder / "dark.png", 2 * kPanel)), 0.6 * mean_of(start));
    EXPECT_GT(mean_difference(start, scene_part(folder / "normal.png", 2 * kPanel)), 0.01);
    // The screen shows the picture of the same command, pixel by pixel.
    const FloatImage picture = read_image(folder / "kilolux-001.png");
    EXPECT_EQ(picture.width, 1400 - 2 * kPanel);
    EXPECT_EQ(picture.height, 840);
    const FloatImage screen = read_image(folder / "normal.png");
    for (int y = 2 * kUnderlay; y < picture.height; y += 7) {
        for (int x = 0; x < picture.width; x += 5) {
            for (int c = 0; c < 3; ++c) {
                const auto value = [c](const FloatImage& image, int column, int row) {
                    const int pixel = row * image.width + column;
                    const int channels = static_cast<int>(image.channels.size());
                    return image.values.at(static_cast<std::size_t>(pixel * channels + c));
                };
                ASSERT_NEAR(value(screen, x + 2 * kPanel, y), value(picture, x, y), 1.1f / 255.0f)
                    << x << ", " << y;
            }
        }
    }
}

TEST(ScreenDensity, SizesAreKeptForAnyScreen) {
    const TemporaryFolder folder;
    const std::string config = "XDG_CONFIG_HOME=" + folder.path().string();
    const auto kept_size = [&](const std::string& lines, const std::vector<std::string>& display) {
        const std::string script = Script(folder).line(lines).shot("end").write();
        const ChildResult result = view_in_display(
            {config}, {"view", "plain", "-q", "--lights", "100", "--script", script}, display);
        EXPECT_EQ(result.code, 0) << result.err;
        const auto kept = nlohmann::json::parse(text_of_file(folder / "kilolux" / "view.json"));
        return kept.at("resolution").get<std::string>();
    };
    const std::string size = "620,400";
    EXPECT_EQ(kept_size("resize 620 400", kUsual), size);
    EXPECT_EQ(kept_size("frames 2", kDense), size);
    EXPECT_EQ(read_image(folder / "end.png").width, 1240);
    // The size of full screen is not kept.
    EXPECT_EQ(kept_size("key F11 0", kUsual), size);
    EXPECT_EQ(read_image(folder / "end.png").width, 1500);
}

}  // namespace
}  // namespace kilolux
